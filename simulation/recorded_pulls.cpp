#include "recorded_pulls.h"

#include <nlohmann/json.hpp>

#include "musclesim/base/error.h"

namespace musclesim {

namespace {

nlohmann::json toJson(const Vector& v) {
  return {v.x(), v.y(), v.z()};
}

Vector vectorFrom(const nlohmann::json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

TimedPull pullFrom(const nlohmann::json& entry) {
  TimedPull timed{entry.at("time_s").get<double>(), {}};
  if (entry.contains("part"))
    timed.pull = Pull{entry.at("part").get<std::size_t>(), vectorFrom(entry.at("point_mm")), vectorFrom(entry.at("towards_mm"))};
  return timed;
}

}  // namespace

std::vector<TimedPull> pullsOf(const InputHistory& history, double step_s) {
  std::vector<TimedPull> pulls;
  std::optional<Pull> before;
  for (const auto& [step, input] : history.changes) {
    if (input.pull == before) continue;
    pulls.push_back({static_cast<double>(step) * step_s, input.pull});
    before = input.pull;
  }
  return pulls;
}

std::string toJson(const std::vector<TimedPull>& pulls) {
  nlohmann::json list = nlohmann::json::array();
  for (const TimedPull& timed : pulls) {
    nlohmann::json entry = {{"time_s", timed.time_s}};
    if (timed.pull) {
      entry["part"] = timed.pull->part;
      entry["point_mm"] = toJson(timed.pull->point_mm);
      entry["towards_mm"] = toJson(timed.pull->towards_mm);
    }
    list.push_back(entry);
  }
  return list.dump();
}

std::vector<TimedPull> recordedPulls(const RecordingInfo& info, const std::string& source) {
  const auto extra = nlohmann::json::parse(info.extra_json, nullptr, false);
  if (!extra.is_object() || !extra.contains("pulls")) return {};
  try {
    std::vector<TimedPull> pulls;
    for (const auto& entry : extra["pulls"]) pulls.push_back(pullFrom(entry));
    return pulls;
  } catch (const nlohmann::json::exception& error) {
    throw BadFile(source, std::string("\"pulls\" is no list of pulls: ") + error.what());
  }
}

}  // namespace musclesim
