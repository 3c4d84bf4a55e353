/// The engines that were built. Each is a library of its own beside the program, which needs none of them.
#pragma once

#include <string>
#include <vector>

#include "engine.h"

namespace musclesim::peers {

struct LoadedEngine {
  std::string name;                    ///< MuJoCo, Simbody, Bullet
  const PeerEngine* engine = nullptr;  ///< null: not there
  std::string reason;                  ///< why not
};

/// Looks for peers/musclesim_peer_NAME.so in the program's folder.
std::vector<LoadedEngine> loadEngines();

}  // namespace musclesim::peers
