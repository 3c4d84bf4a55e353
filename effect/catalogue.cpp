#include "catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <mutex>

#include "body/attachment_offset.h"
#include "body/base_tilt.h"
#include "body/contact.h"
#include "body/external_force.h"
#include "body/joint_coulomb_friction.h"
#include "body/joint_stiffness.h"
#include "body/joint_stop_offset.h"
#include "body/joint_viscous_friction.h"
#include "body/payload.h"
#include "body/slide_friction.h"
#include "command/channel_swap.h"
#include "command/command_dead_band.h"
#include "command/command_quantisation.h"
#include "command/transport_delay.h"
#include "force/braid_hysteresis.h"
#include "force/creep.h"
#include "force/force_drift.h"
#include "force/force_gain.h"
#include "force/length_offset.h"
#include "force/other_force_law.h"
#include "force/series_elasticity.h"
#include "force/threshold_pressure.h"
#include "force/viscous_loss.h"
#include "musclesim/base/error.h"
#include "pressure/flow_limit.h"
#include "pressure/leak.h"
#include "pressure/pressure_calibration.h"
#include "pressure/regulator_tail.h"
#include "pressure/supply_droop.h"
#include "pressure/valve_lag.h"
#include "pressure/volume_coupling.h"
#include "sensor/sensor_backlash.h"
#include "sensor/sensor_bias.h"
#include "sensor/sensor_delay.h"
#include "sensor/sensor_dropout.h"
#include "sensor/sensor_gain.h"
#include "sensor/slow_clock.h"

namespace musclesim {

std::vector<EffectInfo> builtInEffects() {
  return {
      // command: from the controller to the valve
      ChannelSwap::info(),
      CommandDeadBand::info(),
      CommandQuantisation::info(),
      TransportDelay::info(),
      // pressure: from the supply to the muscle
      SupplyDroop::info(),
      PressureCalibration::info(),
      RegulatorTail::info(),
      ValveLag::info(),
      FlowLimit::info(),
      Leak::info(),
      VolumeCoupling::info(),
      // force: from inside, the force law, to outside, the bone
      OtherForceLaw::info(),
      ThresholdPressure::info(),
      ForceGain::info(),
      ForceDrift::info(),
      BraidHysteresis::info(),
      LengthOffset::info(),
      ViscousLoss::info(),
      Creep::info(),
      SeriesElasticity::info(),
      // body: first what changes the robot, then what loads it
      AttachmentOffset::info(),
      BaseTilt::info(),
      Payload::info(),
      JointStopOffset::info(),
      JointCoulombFriction::info(),
      JointViscousFriction::info(),
      JointStiffness::info(),
      SlideFriction::info(),
      ExternalForce::info(),
      Contact::info(),
      // sensor: from the motion to the recording
      SensorBacklash::info(),
      SensorGain::info(),
      SensorBias::info(),
      SensorDelay::info(),
      SlowClock::info(),
      SensorDropout::info(),
  };
}

namespace {

std::mutex& registryMutex() {
  static std::mutex mutex;
  return mutex;
}

std::vector<EffectInfo>& registry() {
  static std::vector<EffectInfo> effects = builtInEffects();
  return effects;
}

std::string withUnit(double value, const std::string& unit) {
  return fmt::format("{}{}{}", value, unit.empty() ? "" : " ", unit);
}

/// The number that a file's number or word stands for.
double numberOf(const EffectParameter& parameter, const Parameter::Value& value, const std::string& name) {
  if (const auto* word = std::get_if<std::string>(&value)) {
    const auto found = std::find(parameter.choices.begin(), parameter.choices.end(), *word);
    if (found == parameter.choices.end())
      throw BadParameter(name, "\"" + *word + "\"",
                         parameter.choices.empty() ? "be a number" : fmt::format("be one of {}", fmt::join(parameter.choices, ", ")));
    return static_cast<double>(found - parameter.choices.begin());
  }
  const double number = std::get<double>(value);
  const bool whole = parameter.choices.empty() || number == std::round(number);
  if (!(number >= parameter.minimum && number <= parameter.maximum && whole))  // false for NaN too
    throw BadParameter(name, withUnit(number, parameter.unit),
                       parameter.choices.empty()
                           ? fmt::format("be a number in {} .. {}", parameter.minimum, withUnit(parameter.maximum, parameter.unit))
                           : fmt::format("be one of {}", fmt::join(parameter.choices, ", ")));
  return number;
}

}  // namespace

std::vector<EffectInfo> effectCatalogue() {
  const std::lock_guard lock(registryMutex());
  std::vector<EffectInfo> listed;
  std::ranges::copy_if(registry(), std::back_inserter(listed), &EffectInfo::listed);
  return listed;
}

std::size_t effectRank(const std::string& id) {
  const std::lock_guard lock(registryMutex());
  std::size_t rank = 0;
  for (const EffectInfo& info : registry()) {
    if (!info.listed) continue;
    if (info.id == id) break;
    ++rank;
  }
  return rank;
}

EffectInfo effectInfo(const std::string& id) {
  std::vector<std::string> ids;
  {
    const std::lock_guard lock(registryMutex());
    for (const EffectInfo& info : registry()) {
      if (info.id == id) return info;
      if (info.listed) ids.push_back(info.id);
    }
  }
  const std::string nearest = nearestName(id, ids);
  throw BadParameter(fmt::format("there is no effect \"{}\"{} (musclesim effects lists all)", id,
                                 nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
}

void requireUsable(const EffectInfo& info) {
  if (info.id.empty() || info.acts_on.empty() || !info.make)
    throw BadParameter("effect \"" + info.id + "\": it needs an id, something to act on and a factory");
  for (const EffectParameter& parameter : info.parameters)
    if (parameter.name.empty() || !(parameter.minimum <= parameter.neutral && parameter.neutral <= parameter.maximum))
      throw BadParameter(
          fmt::format("effect {}: parameter \"{}\" needs a name and a neutral value within its range", info.id, parameter.name));
}

void registerEffect(EffectInfo info) {
  requireUsable(info);
  const std::lock_guard lock(registryMutex());
  const auto found = std::find_if(registry().begin(), registry().end(), [&](const EffectInfo& known) { return known.id == info.id; });
  if (found != registry().end())
    *found = std::move(info);
  else
    registry().push_back(std::move(info));
}

std::vector<double> effectValues(const EffectInfo& info, const ActiveEffect& effect) {
  std::vector<double> values;
  for (const EffectParameter& parameter : info.parameters) {
    const auto given = effect.parameters.find(parameter.name);
    values.push_back(given == effect.parameters.end() ? parameter.neutral
                                                      : numberOf(parameter, given->second, info.id + "." + parameter.name));
  }
  for (const auto& [name, value] : effect.parameters) {
    std::vector<std::string> names;
    for (const EffectParameter& parameter : info.parameters) names.push_back(parameter.name);
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw BadParameter(fmt::format("effect {} has no parameter \"{}\"; it has {}", info.id, name,
                                     names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
  }
  return values;
}

bool isNeutral(const EffectInfo& info, const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!info.parameters[i].shape && values[i] != info.parameters[i].neutral) return false;
  return !info.parameters.empty();
}

ActiveEffect activeEffect(const EffectInfo& info, const std::string& component, const std::vector<double>& values) {
  ActiveEffect effect{info.id, component, {}};
  for (std::size_t i = 0; i < info.parameters.size(); ++i) {
    const EffectParameter& parameter = info.parameters[i];
    if (parameter.choices.empty())
      effect.parameters[parameter.name] = values.at(i);
    else
      effect.parameters[parameter.name] = parameter.choices.at(static_cast<std::size_t>(values.at(i)));
  }
  return effect;
}

}  // namespace musclesim
