#include "mistakes.hpp"

#include <algorithm>
#include <cstddef>

#include "cambium/core/nearest_names.hpp"

namespace examples {

std::string unknown_words(std::vector<std::string> const& words, std::vector<std::string> const& options) {
  // Words after an unknown option are probably its values, so report the option.
  auto const unknown =
      std::find_if(words.begin(), words.end(), [](std::string const& word) { return word.rfind('-', 0) == 0; });
  if (unknown == words.end())
    return "does not know what to do with '" + (words.empty() ? std::string() : words.front()) +
           "' (--help lists the options)";
  auto const word = unknown->substr(0, unknown->find('='));
  std::string text = "there is no option " + word;
  auto const near = cambium::detail::nearest_names(word, options);
  for (std::size_t i = 0; i < near.size(); ++i) text += (i == 0 ? "; is it " : " or ") + near[i];
  return text + (near.empty() ? " (--help lists the options)" : "? (--help lists the options)");
}

std::string without_functions(std::string text) {
  auto const at = text.find("see Map::");
  if (at != std::string::npos)
    text.replace(at, text.find(" for ", at) - at, "look at examples/run map FILE --picture OUT.html");
  return text;
}

}  // namespace examples
