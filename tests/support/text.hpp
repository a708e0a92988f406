#pragma once

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

/// What tests do with texts and files.
namespace support {

/// A file's bytes; empty where it cannot be read.
inline std::string content_of(std::filesystem::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// How often `part` occurs in a text.
inline std::size_t count(std::string const& text, std::string const& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

inline bool has(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

/// The parts of a text between separators, the last one only if it is not empty.
inline std::vector<std::string> split(std::string const& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// The number behind a key in a text of JSON, the first of that name; NaN where it is missing.
inline double value_of(std::string const& json, std::string const& key) {
  auto const at = json.find("\"" + key + "\":");
  if (at == std::string::npos) return std::numeric_limits<double>::quiet_NaN();
  return std::strtod(json.c_str() + at + key.size() + 3, nullptr);
}

}  // namespace support
