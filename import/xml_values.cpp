#include "xml_values.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>

#include "musclesim/base/text.h"

namespace musclesim {

void parseXml(tinyxml2::XMLDocument& document, const std::string& text, const std::string& file) {
  if (document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS)
    throw BadFile(file, document.ErrorLineNum(), 0, fmt::format("not well-formed XML ({})", document.ErrorName()));
  if (!document.RootElement()) throw BadFile(file, "there is no XML element");
}

void refuse(const XmlElement& element, const std::string& file, const std::string& what) {
  const void* included_file = element.GetDocument()->GetUserData();
  throw BadFile(included_file ? *static_cast<const std::string*>(included_file) : file, element.GetLineNum(), 0,
                fmt::format("<{}>: {}", element.Name(), what));
}

std::string textOf(const XmlElement& element, const char* attribute) {
  const char* text = element.Attribute(attribute);
  return text ? text : "";
}

std::vector<double> numbersIn(const std::string& text, std::size_t least, std::size_t most, const XmlElement& element,
                              const std::string& attribute, const std::string& file) {
  constexpr std::string_view space = " \t\r\n";
  std::vector<double> values;
  for (std::size_t at = text.find_first_not_of(space); at != std::string::npos; at = text.find_first_not_of(space, at)) {
    const std::size_t end = std::min(text.find_first_of(space, at), text.size());
    const std::size_t begin = text[at] == '+' ? at + 1 : at;  // from_chars knows no plus sign
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data() + begin, text.data() + end, value);
    if (error != std::errc() || stop != text.data() + end || !std::isfinite(value))
      refuse(element, file, fmt::format("{} = {}: must be finite numbers", attribute, inQuotes(text)));
    values.push_back(value);
    at = end;
  }
  if (values.size() < least || values.size() > most)
    refuse(element, file,
           fmt::format("{} = {}: must be {} numbers", attribute, inQuotes(text),
                       least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most)));
  return values;
}

double numberOf(const XmlElement& element, const char* attribute, double default_value, const std::string& file) {
  if (!element.Attribute(attribute)) return default_value;
  return numbersIn(element.Attribute(attribute), 1, 1, element, attribute, file)[0];
}

Eigen::Vector3d vectorOf(const XmlElement& element, const char* attribute, const Eigen::Vector3d& default_value, const std::string& file) {
  if (!element.Attribute(attribute)) return default_value;
  return Eigen::Vector3d(numbersIn(element.Attribute(attribute), 3, 3, element, attribute, file).data());
}

std::vector<const XmlElement*> childrenOf(const XmlElement& element, const char* name) {
  std::vector<const XmlElement*> children;
  for (const XmlElement* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    if (const void* included = child->GetUserData()) {
      const auto more = childrenOf(*static_cast<const XmlElement*>(included), name);
      children.insert(children.end(), more.begin(), more.end());
    } else if (!name || std::string_view(child->Name()) == name) {
      children.push_back(child);
    }
  }
  return children;
}

}  // namespace musclesim
