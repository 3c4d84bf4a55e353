/// An effect of one's own: a kinked hose, through which a muscle that is shorter than some length fills and vents slowly.
#include <cmath>
#include <cstdio>

#include "musclesim/effect/catalogue.h"
#include "musclesim/simulation/replay.h"

using namespace musclesim;

/// dp/dt = (u - p) / tau while l < l_k, p = u otherwise.
class KinkedHose : public MuscleRatioEffect {
 public:
  explicit KinkedHose(const EffectValues& values) : tau_s_(values["time_constant_s"]), kink_mm_(values["kink_length_mm"]) {}

 private:
  double output(double u, const StepTime& time) override {
    const bool kinked = actuator().lengthMm() < kink_mm_ && tau_s_ > 0;
    return p_ = kinked ? u + (p_ - u) * std::exp(-time.h_s / tau_s_) : u;
  }
  double settled(double u) override { return p_ = u; }

  double tau_s_, kink_mm_, p_ = 0;
};

int main() {
  registerEffect(
      {.id = "kinked_hose",
       .stage = Stage::pressure,
       .acts_on = {ComponentKind::muscle},
       .summary = "a hose kinks when the muscle is short",
       .equation = "dp/dt = (u - p) / tau while l < l_k, p = u otherwise",
       .signature = "slow below a length, prompt above",
       .source = "own observation",
       .parameters = {{"time_constant_s", "s", 0, 0, 5, 0.05, 0.5, "tau"}, {"kink_length_mm", "mm", 230, 0, 1000, 200, 260, "l_k", true}},
       .make = [](const EffectValues& values) { return std::make_unique<KinkedHose>(values); }});
  Recording steps;  // what is commanded: up and down once
  steps.info.robot = "rig";
  steps.signals = {{"command_0", {}}};
  for (int row = 0; row < 200; ++row) {
    steps.time_s.push_back(0.01 * row);
    steps.signals[0].values.push_back(row > 50 && row < 120 ? 0.6 : 0.3);
  }
  ReplayOptions kinked;
  kinked.effects = {{"kinked_hose", "muscle_0", {{"time_constant_s", 0.2}}}};
  const Recording with = replayRecording(steps, kinked).simulated, without = replayRecording(steps).simulated;
  double largest_mm = 0;
  for (std::size_t row = 0; row < steps.time_s.size(); ++row)
    largest_mm = std::fmax(largest_mm, std::fabs(with.find("length_0_mm")->values[row] - without.find("length_0_mm")->values[row]));
  std::printf("%zu effects in the catalogue, the last is %s; it moves the load by up to %.1f mm\n", effectCatalogue().size(),
              effectCatalogue().back().id.c_str(), largest_mm);
  return largest_mm > 5 ? 0 : 1;
}
