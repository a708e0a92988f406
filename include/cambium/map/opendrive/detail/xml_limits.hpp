#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "cambium/core/error.hpp"
#include "cambium/map/opendrive/reading_limits.hpp"

namespace cambium::inline v0_1::map::detail {

/// An XML text that the parser will take for UTF-16 or UTF-32, by its first bytes, as one byte a unit: what is not
/// ASCII becomes an x. Nothing of a text in another encoding.
[[nodiscard]] inline std::string narrowed(std::string_view text) {
  using namespace std::string_view_literals;
  struct Encoding {
    std::string_view begin;
    std::size_t width, low;  // bytes of a unit, and which of them holds ASCII
  };
  constexpr Encoding encodings[] = {{"\0\0\xfe\xff"sv, 4, 3}, {"\xff\xfe\0\0"sv, 4, 0}, {"\0\0\0<"sv, 4, 3},
                                    {"<\0\0\0"sv, 4, 0},      {"\xfe\xff"sv, 2, 1},     {"\xff\xfe"sv, 2, 0},
                                    {"\0<"sv, 2, 1},          {"<\0"sv, 2, 0}};
  std::string narrow;
  auto const* const found = std::find_if(std::begin(encodings), std::end(encodings),
                                         [text](Encoding const& e) { return text.starts_with(e.begin); });
  if (found == std::end(encodings)) return narrow;
  narrow.reserve(text.size() / found->width);
  for (std::size_t i = 0; i + found->width <= text.size(); i += found->width) {
    auto unit = text.substr(i, found->width);
    char const c = unit[found->low];
    bool const is_ascii = std::count(unit.begin(), unit.end(), '\0') + (c != '\0') == std::ptrdiff_t(found->width);
    narrow += is_ascii ? c : 'x';
  }
  return narrow;
}

/// Goes once over an XML text and counts, so that what would take a machine's memory is refused before it does. It must
/// see what the parser sees: comments, data sections and values end where pugixml ends them. Text that is not
/// well-formed is left to the parser; a document type with declarations of its own is refused.
class XmlCounter {
 public:
  explicit XmlCounter(std::string_view text) : text_(text) {}

  /// Throws `MapError` where the text is beyond the limits; `file` names it.
  void check(std::string const& file) {
    while ((at_ = text_.find('<', at_)) != text_.npos) {
      step(file);
      if (depth_ > deepest_element)
        throw MapError(place(file),
                       "elements are nested " + std::to_string(depth_) + " deep here; at most " +
                           std::to_string(deepest_element) + " are read, and OpenDRIVE's own are less than 20 deep",
                       "repair the file there, or export it again");
      if (count_ > most_elements)
        throw MapError(place(file),
                       "up to here there are " + std::to_string(count_) + " elements and attributes; at most " +
                           std::to_string(most_elements) + " are read",
                       "split the map, or remove what is not needed");
    }
  }

 private:
  /// From one '<' to behind its tag, comment or the like.
  void step(std::string const& file) {
    auto const rest = text_.substr(at_);
    for (auto const& [begin, end] : {std::pair{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}})
      if (rest.starts_with(begin)) return skip(std::string_view(begin).size(), end);
    if (rest.starts_with("<!DOCTYPE")) return skip_document_type(file);
    if (rest.starts_with("</")) depth_ -= depth_ > 0;
    if (rest.starts_with("</") || rest.starts_with("<!")) return static_cast<void>(at_ += 2);
    ++depth_;
    ++count_;
    // To the end of the tag, over the attributes' values. (Byte by byte: words are too short for a search.)
    for (; at_ < text_.size() && text_[at_] != '>'; ++at_) {
      if (!is_quote(text_[at_])) continue;
      ++count_;
      skip_value();
    }
    at_ = std::min(at_, text_.size());
    if (at_ < text_.size() && text_[at_ - 1] == '/') --depth_;
  }

  void skip_document_type(std::string const& file) {
    for (++at_; at_ < text_.size() && text_[at_] != '>'; ++at_) {
      if (text_[at_] == '[' || text_[at_] == '<')
        throw MapError(place(file), "the <!DOCTYPE> has declarations or comments of its own, which are not read",
                       "leave out what is between its name and its >");
      if (is_quote(text_[at_])) skip_value();
    }
  }

  [[nodiscard]] static bool is_quote(char c) { return c == '"' || c == '\''; }

  /// From a quote to that which ends it.
  void skip_value() {
    char const quote = text_[at_];
    do ++at_;
    while (at_ < text_.size() && text_[at_] != quote);
  }

  /// From the begin of a comment or the like, `begin` bytes long, to its end.
  void skip(std::size_t begin, std::string_view end) { at_ = std::min(text_.find(end, at_ + begin), text_.size()); }

  [[nodiscard]] std::string place(std::string const& file) const {
    auto const end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size()));
    return file + ":" + std::to_string(std::count(text_.begin(), end, '\n') + 1);
  }

  std::string_view text_;
  std::size_t at_ = 0, depth_ = 0, count_ = 0;
};

}  // namespace cambium::inline v0_1::map::detail
