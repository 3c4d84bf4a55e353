#include "other_force_law.h"

#include <algorithm>

#include "musclesim/robot/actuator.h"
#include "musclesim/robot/chou_hannaford.h"
#include "musclesim/robot/force_map.h"
#include "musclesim/robot/sarosi.h"
#include "musclesim/robot/world.h"

namespace musclesim {

namespace {

enum Law { own, braun, chou_hannaford, sarosi, map, corrected };

EffectParameter constant(const std::string& name, const std::string& unit, double neutral, const std::string& meaning) {
  constexpr double usual_low_ratio = 0.7, usual_high_ratio = 1.3, largest = 1e6;
  const double low = usual_low_ratio * neutral, high = usual_high_ratio * neutral;
  return {name, unit, neutral, -largest, largest, std::min(low, high), std::max(low, high), meaning, true};
}

std::vector<EffectParameter> lawParameters() {
  const BraunConstants b;
  const ChouHannafordConstants c;
  const SarosiConstants s;
  return {{"law",
           "",
           0,
           0,
           5,
           0,
           5,
           "law that replaces the model's; corrected: the chou-hannaford formula is added to the model's law",
           false,
           {"own", "braun", "chou-hannaford", "sarosi", "map", "corrected"}},
          {"rest_length_mm", "mm", 0, 0, 1e4, 0, 400, "rest length of the law; 0: that of the model's law", true},
          constant("a", "", b.a, "braun"),
          constant("b", "", b.b, "braun"),
          constant("c_kgf", "kgf", b.c_kgf, "braun"),
          constant("braid_N", "N", c.braid_N, "chou-hannaford: A"),
          constant("bore_N", "N", c.bore_N, "chou-hannaford: B"),
          constant("elastic_N", "N", c.elastic_N, "chou-hannaford: C"),
          constant("threshold_N", "N", c.threshold_N, "chou-hannaford: D"),
          constant("stretch_N", "N", c.stretch_N, "chou-hannaford: E"),
          constant("stretch_exponent", "", c.stretch_exponent, "chou-hannaford: beta"),
          constant("a1_N", "N", s.a1_N, "sarosi"),
          constant("a2_N", "N", s.a2_N, "sarosi"),
          constant("a3", "", s.a3, "sarosi"),
          constant("a4_N", "N", s.a4_N, "sarosi"),
          constant("a5_N", "N", s.a5_N, "sarosi"),
          constant("a6_N", "N", s.a6_N, "sarosi")};
}

ChouHannafordConstants chouHannafordConstants(const EffectValues& v) {
  ChouHannafordConstants c;
  c.braid_N = v["braid_N"];
  c.bore_N = v["bore_N"];
  c.elastic_N = v["elastic_N"];
  c.threshold_N = v["threshold_N"];
  c.stretch_N = v["stretch_N"];
  c.stretch_exponent = v["stretch_exponent"];
  return c;
}

SarosiConstants sarosiConstants(const EffectValues& v) {
  SarosiConstants s;
  s.a1_N = v["a1_N"];
  s.a2_N = v["a2_N"];
  s.a3 = v["a3"];
  s.a4_N = v["a4_N"];
  s.a5_N = v["a5_N"];
  s.a6_N = v["a6_N"];
  return s;
}

BraunConstants braunConstants(const EffectValues& v) {
  BraunConstants b;
  b.a = v["a"];
  b.b = v["b"];
  b.c_kgf = v["c_kgf"];
  return b;
}

}  // namespace

EffectInfo OtherForceLaw::info() {
  return {.id = "force_law",
          .stage = Stage::force,
          .acts_on = {ComponentKind::muscle},
          .summary = "the muscle follows another static force law than the model",
          .equation = "F' = G(p, l), or F' = max(0, F + G(p, l))    G another law, p pressure, l length",
          .signature = "the static map of tension deviates smoothly, the same in both directions",
          .source = "Braun 2007; Chou and Hannaford 1996; Sarosi 2012; measured maps",
          .parameters = lawParameters(),
          .make = [](const EffectValues& values) { return std::make_unique<OtherForceLaw>(values); },
          .replaces_law = true};
}

void OtherForceLaw::attach(const EffectPlace& place) {
  ForceEffect::attach(place);
  const double given_mm = values_["rest_length_mm"];
  const double rest_mm = given_mm > 0 ? given_mm : actuator().restLengthMm();
  const auto law = static_cast<Law>(values_["law"]);
  adds_ = law == corrected;
  if (law == chou_hannaford || law == corrected)
    law_ = std::make_unique<ChouHannafordForceLaw>(rest_mm, chouHannafordConstants(values_));
  else if (law == sarosi)
    law_ = std::make_unique<SarosiForceLaw>(rest_mm, sarosiConstants(values_));
  else if (law == map)
    law_ = std::make_unique<ForceMap>(rest_mm, ForceMapTable(world().parameters()));
  else
    law_ = std::make_unique<BraunForceLaw>(actuator().contractedLengthMm(), rest_mm, braunConstants(values_));
}

double OtherForceLaw::tensionN(const MuscleInput& input, const ForceBelow& below) const {
  if (!adds_) return law_->tensionN(input.pressure_ratio, input.length_mm);
  return std::max(0.0, below(input) + law_->formulaN(input.pressure_ratio, input.length_mm));
}

}  // namespace musclesim
