/// Reads values from XML elements; every error names the file and the line.
#pragma once

#include <tinyxml2.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/base/error.h"

namespace musclesim {

using XmlElement = tinyxml2::XMLElement;

/// Parses a text whose outermost element is known. Throws BadFile with the line if it is not well-formed.
void parseXml(tinyxml2::XMLDocument& document, const std::string& text, const std::string& file);

/// Throws BadFile at the element's line of `file`, or of an included file: the user data of its document is the name, a std::string.
[[noreturn]] void refuse(const XmlElement& element, const std::string& file, const std::string& what);

/// The attribute's text, empty if there is none.
std::string textOf(const XmlElement& element, const char* attribute);

/// Numbers separated by white space, all finite. Throws BadFile unless there are `least` to `most` of them. `element` and `attribute` are
/// named in the message.
std::vector<double> numbersIn(const std::string& text, std::size_t least, std::size_t most, const XmlElement& element,
                              const std::string& attribute, const std::string& file);

/// The attribute as one or three numbers; the default if there is no such attribute.
double numberOf(const XmlElement& element, const char* attribute, double default_value, const std::string& file);
Eigen::Vector3d vectorOf(const XmlElement& element, const char* attribute, const Eigen::Vector3d& default_value, const std::string& file);

/// The children of an element, in order; with a name: those of that name. An element whose user data is the outermost element of an
/// included file stands for the children of that one.
std::vector<const XmlElement*> childrenOf(const XmlElement& element, const char* name = nullptr);

}  // namespace musclesim
