#include <algorithm>

#include "mechanism.h"
#include "musclesim/base/error.h"
#include "musclesim/robot/actuator.h"

namespace musclesim::peers {

namespace {

class TreeBuilder {
 public:
  explicit TreeBuilder(const Mechanism& mechanism)
      : mechanism_(mechanism), depth_(mechanism.bodies.size(), unreached), done_(mechanism.joints.size(), false) {}

  Tree build() {
    std::vector<bool> of_chain(mechanism_.joints.size(), false);
    for (const MuscleParts& muscle : mechanism_.muscles)
      for (const int joint : chainOf(muscle)) of_chain[static_cast<std::size_t>(joint)] = true;
    for (bool grown = true; grown;) {
      grown = false;
      for (std::size_t j = 0; j < done_.size(); ++j)
        if (!of_chain[j]) grown = take(static_cast<int>(j)) || grown;
    }
    addFreeBones();
    for (const MuscleParts& muscle : mechanism_.muscles)
      for (const int joint : chainFromNearerEnd(muscle)) take(joint);
    return tree_;
  }

 private:
  static constexpr int unreached = -1;

  int depthOf(int body) const { return body == environment ? 0 : depth_[static_cast<std::size_t>(body)]; }

  static std::vector<int> chainOf(const MuscleParts& muscle) {
    std::vector<int> chain;
    if (muscle.sliders.empty()) return chain;
    chain.push_back(muscle.start_joint);
    for (std::size_t i = 0; i < muscle.sliders.size(); ++i) {
      if (i > 0) chain.push_back(muscle.hinges[i - 1]);
      chain.push_back(muscle.sliders[i]);
    }
    chain.push_back(muscle.end_joint);
    if (chain.front() < 0 || chain.back() < 0) throw BadParameter(muscle.actuator->name() + ": a chain with a loose end");
    return chain;
  }

  std::vector<int> chainFromNearerEnd(const MuscleParts& muscle) const {
    std::vector<int> chain = chainOf(muscle);
    if (chain.empty()) return chain;
    const auto bone = [this](int joint) { return mechanism_.joints[static_cast<std::size_t>(joint)].second; };
    if (depthOf(bone(chain.back())) < depthOf(bone(chain.front()))) std::reverse(chain.begin(), chain.end());
    return chain;
  }

  /// Uses a joint of which at least one body has been reached. Returns whether there is a new body.
  bool take(int index) {
    const auto j = static_cast<std::size_t>(index);
    const BodyJoint& joint = mechanism_.joints[j];
    if (done_[j]) return false;
    const bool reached[2] = {depthOf(joint.first) != unreached, depthOf(joint.second) != unreached};
    if (!reached[0] && !reached[1]) return false;
    done_[j] = true;
    if (joint.first == joint.second) return false;
    if (reached[0] && reached[1]) {
      if (joint.kind != Joint::Kind::ball)
        throw BadParameter("joint " + joint.source->name() + " closes a loop: models of other engines close loops with balls only");
      tree_.loops.push_back(index);
      return false;
    }
    const int body = reached[1] ? joint.first : joint.second, parent = reached[1] ? joint.second : joint.first;
    depth_[static_cast<std::size_t>(body)] = depthOf(parent) + (joint.kind == Joint::Kind::fixed ? 0 : 1);
    tree_.nodes.push_back({body, parent, index, !reached[1]});
    return true;
  }

  /// Bones that no joint connects with the environment.
  void addFreeBones() {
    std::size_t bone_count = mechanism_.bodies.size();
    for (const MuscleParts& muscle : mechanism_.muscles) bone_count -= 2 * muscle.sliders.size();
    for (std::size_t body = 0; body < bone_count; ++body) {
      if (depth_[body] != unreached) continue;
      depth_[body] = 1;
      tree_.nodes.push_back({static_cast<int>(body), environment, -1, false});
      for (bool grown = true; grown;) {
        grown = false;
        for (std::size_t j = 0; j < done_.size(); ++j)
          if (isOfBones(mechanism_.joints[j], bone_count)) grown = take(static_cast<int>(j)) || grown;
      }
    }
  }
  static bool isOfBones(const BodyJoint& joint, std::size_t bone_count) {
    return joint.first < static_cast<int>(bone_count) && joint.second < static_cast<int>(bone_count);
  }

  const Mechanism& mechanism_;
  std::vector<int> depth_;
  std::vector<bool> done_;
  Tree tree_;
};

}  // namespace

Tree spanningTree(const Mechanism& mechanism) {
  return TreeBuilder(mechanism).build();
}

}  // namespace musclesim::peers
