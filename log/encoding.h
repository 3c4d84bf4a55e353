/// Text of other encodings becomes UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace musclesim {

bool isUtf8(std::string_view text);

/// The text in UTF-8. `encoding`: a name that iconv knows, for example "latin1"; empty: UTF-16 if the text begins with its byte order mark,
/// else the text as it is. Throws BadFile if there is no such encoding, or with the place of the first byte that it does not have.
std::string toUtf8(std::string text, const std::string& encoding, const std::string& file);

}  // namespace musclesim
