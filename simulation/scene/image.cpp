#include "image.h"

#include <png.h>

#include <string_view>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"

namespace musclesim {

namespace {

png_image descriptionOf(const Image& image) {
  png_image description = {};
  description.version = PNG_IMAGE_VERSION;
  description.width = static_cast<png_uint_32>(image.width);
  description.height = static_cast<png_uint_32>(image.height);
  description.format = PNG_FORMAT_RGB;
  return description;
}

}  // namespace

void writePng(const Image& image, const std::string& file) {
  png_image description = descriptionOf(image);
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(description);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&description, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr))
    throw IoError(file + ": cannot be written as PNG: " + description.message);
  replaceFile(file, std::string_view(bytes).substr(0, size));
}

}  // namespace musclesim
