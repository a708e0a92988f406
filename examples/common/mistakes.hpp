#pragma once

#include <string>
#include <vector>

namespace examples {

/// The error message for `words` that no option takes. It suggests similar names from `options`.
[[nodiscard]] std::string unknown_words(std::vector<std::string> const& words, std::vector<std::string> const& options);

/// An error message of the library for the command line: advice to call a function of the map ("see Map::roads for
/// ...") becomes advice to look at the picture of the map.
[[nodiscard]] std::string without_functions(std::string text);

}  // namespace examples
