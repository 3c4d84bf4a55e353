/// Channels: the muscles that one signal moves, with the sense in which it moves them.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

class Robot;

/// A muscle, a group of muscles, or antagonists: pressures rise with the signal in some muscles and fall in others.
struct Channel {
  std::string name;             ///< name of the joint that it moves; empty: not known
  std::vector<int> rise, fall;  ///< muscles by number

  /// "elbow=0:1"
  std::string text() const;
};

/// Reads channels separated by commas. A channel is a group of muscles, or two groups with a colon between, of which the second is the
/// antagonist of the first; a group is one or more muscles with + between. A name and = may stand before:
///     "0,1"            two muscles, each with a signal of its own
///     "0:1"            one antagonistic pair
///     "elbow=0+2:1+3"  two muscles against two, which move the joint elbow
/// Throws BadParameter for another form, a muscle that the robot does not have, and one that is twice in a channel.
std::vector<Channel> channelsFrom(const std::string& text, int muscle_count);

/// The antagonists of a robot, one channel per reported angle: muscles that increase the angle against those that decrease it, by the mean
/// of their moment arms over the joint's range. Muscles with less than `least_share` of the joint's largest arm are left out, since they
/// pass the joint rather than move it. Joints without antagonists are left out.
///
/// Builds the robot once more, by its name or file and with the world's parameters, in a world of its own. Returns nothing for a robot that
/// cannot be built by name, or whose joints close a loop.
std::vector<Channel> antagonistsOf(const Robot& robot);

}  // namespace musclesim
