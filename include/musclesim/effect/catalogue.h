/// The catalogue of effects: one id per physical cause.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "musclesim/effect/effect_info.h"
#include "musclesim/log/active_effect.h"

namespace musclesim {

/// All listed effects in the order in which they act within their stages: those of the library, then registered ones.
std::vector<EffectInfo> effectCatalogue();
/// Throws BadParameter with the nearest id if there is none of that id.
EffectInfo effectInfo(const std::string& id);
/// The place of an effect in effectCatalogue(); that behind the last one for effects that are not listed.
std::size_t effectRank(const std::string& id);
/// Adds an effect to the catalogue; a later registration of the same id replaces the earlier one. Throws BadParameter for an entry without
/// id, component or factory, or with parameters whose neutral value lies outside their range.
void registerEffect(EffectInfo info);

/// The values of all parameters, neutral where none is given. Throws BadParameter for an unknown name, a value out of range or not a
/// number.
std::vector<double> effectValues(const EffectInfo& info, const ActiveEffect& effect);
/// Whether the values change nothing: all parameters that are not shape parameters are neutral. Effects without parameters are never.
bool isNeutral(const EffectInfo& info, const std::vector<double>& values);
/// The entry of an effects file with these values, in the order of info.parameters.
ActiveEffect activeEffect(const EffectInfo& info, const std::string& component, const std::vector<double>& values);

/// The components of a robot that the effect can act on, "all" first where there are several; empty if there is none.
std::vector<std::string> componentsFor(const EffectInfo& info, const Robot& robot);

}  // namespace musclesim
