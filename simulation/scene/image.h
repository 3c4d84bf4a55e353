/// Bitmap images.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace musclesim {

/// Red, green, blue, one byte each, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Writes a PNG file, under a temporary name first. Throws IoError.
void writePng(const Image& image, const std::string& file);

}  // namespace musclesim
