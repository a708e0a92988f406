#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/benchmark/detail/arguments.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/nearest_names.hpp"
#include "cambium/core/text.hpp"

namespace cambium::detail {

CAMBIUM_COLD std::string help_of(Option const& option) {
  constexpr std::size_t begin = 35, end = 118;
  std::string line = "  " + option.name + " " + option.value, text;
  line.resize(std::max(line.size() + 1, begin), ' ');
  for (auto const word : split(option.sentence, " ")) {
    if (line.size() + word.size() > end) {
      line.pop_back();
      text += line + "\n";
      line.assign(begin, ' ');
    }
    line += std::string(word) + " ";
  }
  line.pop_back();
  return text + line + "\n";
}

CAMBIUM_COLD Arguments::Arguments(int argc, char const* const* argv, std::vector<Option> const& options) {
  std::vector<std::string> names;
  for (auto const& option : options) names.push_back(option.name);
  for (int i = 1; i < argc; ++i) {
    std::string word(argv[i]);
    auto const equals = word.find('=');
    auto const name = word.substr(0, equals);
    auto const option =
        std::find_if(options.begin(), options.end(), [&](Option const& known) { return known.name == name; });
    if (option == options.end())
      throw Error(
          word, "is no option",
          (nearest_names(name, names).empty() ? std::string() : suggestion(name, names) + " ") + "(--help lists them)");
    bool const has_value = equals != std::string::npos || (!option->value.empty() && i + 1 < argc);
    if (option->value.empty() ? equals != std::string::npos : !has_value)
      throw Error(name, option->value.empty() ? "takes no value" : "lacks its value",
                  option->value.empty() ? "leave it out" : "write " + name + " " + option->value);
    std::string value;
    if (!option->value.empty()) value = equals != std::string::npos ? word.substr(equals + 1) : argv[++i];
    if (!given_.emplace(name, std::move(value)).second) throw Error(name, "is given twice", "give it once");
  }
}

CAMBIUM_COLD std::optional<std::string> Arguments::text(std::string const& name) const {
  auto const found = given_.find(name);
  return found == given_.end() ? std::nullopt : std::optional(found->second);
}

CAMBIUM_COLD std::optional<std::uint64_t> Arguments::whole(std::string const& name, std::uint64_t low,
                                                           std::uint64_t high) const {
  auto const word = text(name);
  if (!word) return std::nullopt;
  auto const value = parse_number<std::uint64_t>(*word);
  if (!value || *value < low || *value > high)
    throw Error(name, "is '" + *word + "'",
                "give a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  return value;
}

CAMBIUM_COLD std::optional<double> Arguments::seconds(std::string const& name) const {
  auto const word = text(name);
  if (!word) return std::nullopt;
  auto const value = parse_number<double>(*word);
  if (!value || !(*value > 0.0)) throw Error(name, "is '" + *word + "'", "give a number of seconds above 0");
  return value;
}

CAMBIUM_COLD std::vector<std::string> Arguments::list(std::string const& name) const {
  std::vector<std::string> parts;
  if (auto const word = text(name))
    for (auto const part : split(*word, ",")) parts.emplace_back(trimmed(part));
  return parts;
}

}  // namespace cambium::detail
