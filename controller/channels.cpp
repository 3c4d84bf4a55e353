#include "musclesim/controller/channels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <string_view>

#include "../robot/inspection.h"
#include "clean_model.h"
#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr double least_share = 0.3;  ///< of the largest moment arm at a joint, for a muscle to count as one that moves it

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

[[noreturn]] void refuse(std::string_view channel, const std::string& what) {
  throw BadParameter("channel", std::string(channel), what);
}

std::vector<int> groupFrom(std::string_view channel, std::string_view text, int muscle_count) {
  std::vector<int> muscles;
  for (const std::string_view word : split(text, '+')) {
    int muscle = -1;
    const auto read = std::from_chars(word.data(), word.data() + word.size(), muscle);
    if (read.ec != std::errc() || read.ptr != word.data() + word.size())
      refuse(channel, "have a form like 0 (a muscle), 0:1 (antagonists) or elbow=0+2:1+3");
    if (muscle < 0 || muscle >= muscle_count) refuse(channel, fmt::format("name muscles of the robot, 0 .. {}", muscle_count - 1));
    muscles.push_back(muscle);
  }
  return muscles;
}

Channel channelFrom(std::string_view text, int muscle_count) {
  Channel channel;
  std::string_view rest = text;
  if (const auto equals = text.find('='); equals != std::string_view::npos) {
    channel.name = text.substr(0, equals);
    rest = text.substr(equals + 1);
  }
  const auto groups = split(rest, ':');
  if (groups.size() > 2) refuse(text, "have at most one colon");
  channel.rise = groupFrom(text, groups[0], muscle_count);
  if (groups.size() == 2) channel.fall = groupFrom(text, groups[1], muscle_count);
  std::vector<int> all = channel.rise;
  all.insert(all.end(), channel.fall.begin(), channel.fall.end());
  std::ranges::sort(all);
  if (std::ranges::adjacent_find(all) != all.end()) refuse(text, "name every muscle once");
  return channel;
}

}  // namespace

std::string Channel::text() const {
  return fmt::format("{}{}{}{}{}", name, name.empty() ? "" : "=", fmt::join(rise, "+"), fall.empty() ? "" : ":", fmt::join(fall, "+"));
}

std::vector<Channel> channelsFrom(const std::string& text, int muscle_count) {
  std::vector<Channel> channels;
  for (const std::string_view channel : split(text, ',')) channels.push_back(channelFrom(channel, muscle_count));
  return channels;
}

std::vector<Channel> antagonistsOf(const Robot& robot) {
  std::vector<MomentArms> joints;
  try {
    CleanModel model(robot);
    joints = momentArms(model.world(), model.robot());
  } catch (const Error&) {
    return {};
  }
  std::vector<Channel> channels;
  for (const MomentArms& joint : joints) {
    std::vector<double> mean_mm;
    for (const auto& arms : joint.arm_mm)
      mean_mm.push_back(std::accumulate(arms.begin(), arms.end(), 0.0) / static_cast<double>(arms.size()));
    const double largest = std::ranges::max(mean_mm, {}, [](double arm) { return std::abs(arm); });
    Channel channel{joint.joint, {}, {}};
    for (std::size_t muscle = 0; muscle < mean_mm.size(); ++muscle)
      if (std::abs(mean_mm[muscle]) >= least_share * std::abs(largest) && mean_mm[muscle] != 0)
        (mean_mm[muscle] > 0 ? channel.rise : channel.fall).push_back(static_cast<int>(muscle));
    if (!channel.rise.empty() && !channel.fall.empty()) channels.push_back(channel);
  }
  return channels;
}

}  // namespace musclesim
