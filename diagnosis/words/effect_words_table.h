/// The words of every effect of the catalogue and of its parameters.
#pragma once

#include <vector>

namespace musclesim {

/// How a parameter is said. `{}` stands for the number.
struct ParameterWords {
  const char* name;
  const char* label;
  const char* phrase = "";   ///< in a sentence; empty: not in sentences
  const char* percent = "";  ///< of a share of one: how it is said in percent, such as "% of full scale"
};

/// How an effect is said. `{}` stands for what it acts on.
struct EffectWords {
  const char* id;
  const char* title;
  const char* claim;
  const char* claim_below;  ///< if the first parameter lies below its neutral value; null: the same
  const char* explanation;
  std::vector<ParameterWords> parameters;
};

/// By stage, in the order of the catalogue's page.
extern const std::vector<EffectWords> effect_words;

}  // namespace musclesim
