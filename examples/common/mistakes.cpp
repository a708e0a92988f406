#include "mistakes.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace examples {
namespace {

/// Edit distance: the number of letters to change, add or remove (Levenshtein 1966).
std::size_t distance(std::string const& a, std::string const& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      auto const changed = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

/// The options that `word` may stand for, nearest first, at most three.
std::vector<std::string> near_options(std::vector<std::string> const& options, std::string const& word) {
  std::vector<std::pair<std::size_t, std::string>> found;
  for (auto const& name : options) {
    auto const far = distance(word, name);
    bool const begins = word.size() > 3 && name.rfind(word, 0) == 0;
    if (begins || far <= std::max<std::size_t>(1, word.size() / 3)) found.emplace_back(begins ? 0 : far, name);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> names;
  for (auto const& [far, name] : found)
    if (names.size() < 3) names.push_back(name);
  return names;
}

}  // namespace

std::string unknown_words(std::vector<std::string> const& words, std::vector<std::string> const& options) {
  // Words after an unknown option are probably its values, so report the option.
  auto const unknown =
      std::find_if(words.begin(), words.end(), [](std::string const& word) { return word.rfind('-', 0) == 0; });
  if (unknown == words.end())
    return "does not know what to do with '" + (words.empty() ? std::string() : words.front()) +
           "' (--help lists the options)";
  auto const word = unknown->substr(0, unknown->find('='));
  std::string text = "there is no option " + word;
  auto const near = near_options(options, word);
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
