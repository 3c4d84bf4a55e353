/// Writes a figure as an SVG or a PNG file.
#pragma once

#include <string>

namespace musclesim {

/// Throws BadParameter unless a figure's name ends in .svg, or in .png and rsvg-convert is installed.
void requireFigureFile(const std::string& file);

/// Replaces or creates the file. rsvg-convert makes the PNG. Throws as requireFigureFile, and IoError.
void writeFigure(const std::string& file, const std::string& svg);

}  // namespace musclesim
