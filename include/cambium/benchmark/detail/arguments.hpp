#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace cambium::detail {

/// An option of a command line: its name with dashes, the kind of its value ("" for none), and a sentence.
struct Option {
  std::string name, value, sentence;
};

/// An option as a line of a help text, or several.
[[nodiscard]] std::string help_of(Option const& option);

/// A command line of `--name value` and `--name=value`. Throws `Error` for a word that is no option, an option given
/// twice, or one without its value.
class Arguments {
 public:
  Arguments(int argc, char const* const* argv, std::vector<Option> const& options);

  [[nodiscard]] bool has(std::string const& name) const { return given_.contains(name); }
  [[nodiscard]] std::optional<std::string> text(std::string const& name) const;
  [[nodiscard]] std::optional<std::uint64_t> whole(std::string const& name, std::uint64_t low,
                                                   std::uint64_t high) const;
  /// A time above 0.
  [[nodiscard]] std::optional<double> seconds(std::string const& name) const;
  /// The parts of a comma-separated list.
  [[nodiscard]] std::vector<std::string> list(std::string const& name) const;

 private:
  std::map<std::string, std::string> given_;
};

}  // namespace cambium::detail

#ifndef CAMBIUM_COMPILED
#include "cambium/benchmark/detail/arguments_impl.hpp"
#endif
