/// Replaces panel.cpp in a build without Dear ImGui.
#include "panel.h"

namespace musclesim {

std::unique_ptr<Panel> Panel::make() {
  return nullptr;
}

}  // namespace musclesim
