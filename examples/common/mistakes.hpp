#pragma once

#include <string>
#include <vector>

namespace examples {

/// What is wrong with `words` that no option takes: names the near ones of `options`.
[[nodiscard]] std::string unknown_words(std::vector<std::string> const& words, std::vector<std::string> const& options);

/// `text` for the command line: where it sends a programmer to a function of the map ("see Map::roads for ..."), the
/// user goes to the picture.
[[nodiscard]] std::string without_functions(std::string text);

}  // namespace examples
