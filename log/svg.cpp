#include "svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace musclesim {

namespace {

/// Lines of colours brighter than this get a darker outline: yellow, aquamarine, green, pink and light gray, but not orange.
constexpr double casing_brightness = 0.68;
constexpr double casing_darkness_ratio = 0.62;
constexpr double casing_extra_width = 0.9;

/// Length of the valid UTF-8 character that begins at `offset`; 0 if there is none, or one that XML does not allow.
std::size_t characterLength(std::string_view text, std::size_t offset) {
  const auto byte = [&](std::size_t i) { return offset + i < text.size() ? static_cast<unsigned char>(text[offset + i]) : 0U; };
  const auto continues = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  if (first >= 0xC2 && first <= 0xDF) return continues(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const unsigned code = (first & 0x0FU) << 12 | (byte(1) & 0x3FU) << 6 | (byte(2) & 0x3FU);
    const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
    return continues(1) && continues(2) && code >= 0x800 && code < 0xFFFE && !is_surrogate ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const unsigned code = (first & 0x07U) << 18 | (byte(1) & 0x3FU) << 12;
    return continues(1) && continues(2) && continues(3) && code >= 0x10000 && code <= 0x10FFFF ? 4 : 0;
  }
  return 0;
}

/// A number of pixels with at most two decimals.
std::string pixels(double value) {
  std::string text = fmt::format("{:.2f}", value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string pathData(const std::vector<std::vector<SvgPoint>>& pieces) {
  constexpr double dot_half_width = 1.2;
  std::string data;
  for (const auto& piece : pieces) {
    if (piece.empty()) continue;
    const bool is_dot = piece.size() == 1;
    data += fmt::format("M{},{}", pixels(is_dot ? piece[0].x - dot_half_width : piece[0].x), pixels(piece[0].y));
    if (is_dot) data += "h" + pixels(2 * dot_half_width);
    for (std::size_t i = 1; i < piece.size(); ++i)
      data += fmt::format("{}{},{}", i == 1 ? "L" : " ", pixels(piece[i].x), pixels(piece[i].y));
  }
  return data;
}

}  // namespace

std::string escapedXml(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = characterLength(text, i);
    const char character = text[i];
    if (length == 0)
      out += character == '\n' || character == '\t' ? " " : "?";
    else if (character == '<')
      out += "&lt;";
    else if (character == '>')
      out += "&gt;";
    else if (character == '&')
      out += "&amp;";
    else if (character == '"')
      out += "&quot;";
    else if (character == '\'')
      out += "&#39;";
    else
      out += text.substr(i, length);
    i += std::max<std::size_t>(length, 1);
  }
  return out;
}

std::string hexColor(const Color& color) {
  const auto byte = [](double component) { return static_cast<int>(std::lround(255 * (component >= 0 ? std::min(component, 1.0) : 0.0))); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(color.red), byte(color.green), byte(color.blue));
}

Color darkened(const Color& color, double ratio) {
  return {color.red * ratio, color.green * ratio, color.blue * ratio, color.name};
}

double brightness(const Color& color) {
  return 0.2126 * color.red + 0.7152 * color.green + 0.0722 * color.blue;
}

Svg::Svg(double width, double height, const std::string& title) {
  const std::string w = pixels(width), h = pixels(height);
  out_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" role=\"img\" "
      "font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\">\n<title>{}</title>\n"
      "<rect width=\"{}\" height=\"{}\" fill=\"#ffffff\"/>\n",
      w, h, w, h, escapedXml(title), w, h);
}

void Svg::line(SvgPoint from, SvgPoint to, const std::string& color, double width) {
  out_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{}\" stroke-width=\"{}\"/>\n", pixels(from.x), pixels(from.y),
                      pixels(to.x), pixels(to.y), color, pixels(width));
}

void Svg::frame(const SvgBox& box, const std::string& color) {
  out_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1\"/>\n",
                      pixels(box.left), pixels(box.top), pixels(box.width), pixels(box.height), color);
}

void Svg::fill(const SvgBox& box, const std::string& color) {
  out_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n", pixels(box.left), pixels(box.top),
                      pixels(box.width), pixels(box.height), color);
}

void Svg::text(SvgPoint where, const std::string& words, const SvgTextStyle& style) {
  const char* anchor = style.anchor == SvgAnchor::start ? "start" : style.anchor == SvgAnchor::middle ? "middle" : "end";
  const std::string turn = style.turned ? fmt::format(" transform=\"rotate(-90 {} {})\"", pixels(where.x), pixels(where.y)) : "";
  out_ += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{}\" fill=\"{}\"{}{}>{}</text>\n", pixels(where.x),
                      pixels(where.y), pixels(style.size), anchor, style.color, style.bold ? " font-weight=\"bold\"" : "", turn,
                      escapedXml(words));
}

void Svg::path(const std::string& data, const std::string& color, double width, const std::string& attributes, const std::string& hint) {
  const std::string title = hint.empty() ? "" : "<title>" + escapedXml(hint) + "</title>";
  out_ += fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\" stroke-linecap=\"round\"{}>{}</path>\n",
      data, color, pixels(width), attributes, title);
}

void Svg::casedPath(const std::string& data, const Color& color, double width, const std::string& attributes, const std::string& hint) {
  if (brightness(color) > casing_brightness)
    path(data, hexColor(darkened(color, casing_darkness_ratio)), width + casing_extra_width, attributes, hint);
  path(data, hexColor(color), width, attributes, hint);
}

void Svg::curve(const std::vector<std::vector<SvgPoint>>& pieces, const Color& color, double width, const SvgBox& clip,
                const std::string& hint) {
  const std::string data = pathData(pieces);
  if (data.empty()) return;
  ++clip_count_;
  out_ += fmt::format("<clipPath id=\"clip{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n", clip_count_,
                      pixels(clip.left), pixels(clip.top), pixels(clip.width), pixels(clip.height));
  casedPath(data, color, width, fmt::format(" clip-path=\"url(#clip{})\"", clip_count_), hint);
}

void Svg::sample(SvgPoint from, double length, const Color& color, double width) {
  casedPath(pathData({{from, {from.x + length, from.y}}}), color, width, "", "");
}

void Svg::mark(SvgPoint where, SvgMark mark, const Color& color, const std::string& hint) {
  constexpr double radius = 2.6;
  if (mark == SvgMark::none) return;
  if (mark == SvgMark::cross) {
    for (const double way : {-1.0, 1.0})
      line({where.x - radius, where.y - way * radius}, {where.x + radius, where.y + way * radius}, hexColor(color), 1.3);
    return;
  }
  const std::string ink = hexColor(color), title = hint.empty() ? "" : "<title>" + escapedXml(hint) + "</title>";
  out_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1\">{}</circle>\n", pixels(where.x),
                      pixels(where.y), pixels(radius), mark == SvgMark::disc ? ink : "none", ink, title);
}

}  // namespace musclesim
