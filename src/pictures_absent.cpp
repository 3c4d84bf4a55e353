/// Replaces pictures.cpp in a build without the libraries for pictures.
#include "musclesim/base/error.h"
#include "pictures.h"

namespace musclesim::command_line {

std::unique_ptr<Spectator> makePictures(const PictureOptions&, Simulation&, GhostOf) {
  throw BadParameter("this build cannot draw pictures: build it again with libpng-dev, libgl-dev and libosmesa6-dev installed");
}

}  // namespace musclesim::command_line
