#pragma once

#include <string>

namespace remomask::scenes {

/// "a%20b" as "a b". A percent sign without two hexadecimal digits stays.
std::string decode_percent(const std::string& text);

/// The bytes of "data:TYPE;base64,TEXT"; false for anything else.
bool decode_data_uri(const std::string& uri, std::string& bytes);

/// True for a relative path without "..", drive, scheme or control signs.
bool is_name_inside_folder(const std::string& path);

}  // namespace remomask::scenes
