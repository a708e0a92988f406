#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "cambium/core/error.hpp"
#include "cambium/map/reading_limits.hpp"

namespace cambium::map::detail {

/// Goes once over an XML text and counts, so that what would take a machine's memory is refused before it does. Text
/// that is not well-formed is left to the parser.
class XmlCounter {
 public:
  explicit XmlCounter(std::string_view text) : text_(text) {}

  /// Throws `MapError` where the text is beyond the limits; `file` names it.
  void check(std::string const& file) {
    if (text_.size() > largest_map_file)
      throw MapError(file,
                     "it has " + std::to_string(text_.size()) + " bytes, more than the " +
                         std::to_string(largest_map_file) + " that are read",
                     "split the map, or leave out what is not needed of it");
    while ((at_ = text_.find('<', at_)) != text_.npos) {
      step();
      if (depth_ > deepest_element)
        throw MapError(place(file),
                       "the elements lie " + std::to_string(depth_) + " deep here; at most " +
                           std::to_string(deepest_element) + " are read, and OpenDRIVE's own are less than 20 deep",
                       "repair the file there, or export it again");
      if (count_ > most_elements)
        throw MapError(place(file),
                       "up to here there are " + std::to_string(count_) + " elements and attributes; at most " +
                           std::to_string(most_elements) + " are read",
                       "split the map, or leave out what is not needed of it");
    }
  }

 private:
  /// From one '<' to behind its tag, comment or the like.
  void step() {
    auto const rest = text_.substr(at_);
    if (rest.starts_with("<!--")) return skip("-->");
    if (rest.starts_with("<![CDATA[")) return skip("]]>");
    if (rest.starts_with("<?")) return skip("?>");
    if (rest.starts_with("</")) depth_ -= depth_ > 0;
    if (rest.starts_with("</") || rest.starts_with("<!")) return static_cast<void>(at_ += 2);
    ++depth_;
    ++count_;
    // To the end of the tag, over the attributes' values. (Byte by byte: words are too short for a search.)
    for (; at_ < text_.size() && text_[at_] != '>'; ++at_) {
      char const c = text_[at_];
      if (c != '"' && c != '\'') continue;
      ++count_;
      do ++at_;
      while (at_ < text_.size() && text_[at_] != c);
    }
    at_ = std::min(at_, text_.size());
    if (at_ < text_.size() && text_[at_ - 1] == '/') --depth_;
  }

  void skip(std::string_view end) { at_ = std::min(text_.find(end, at_ + 2), text_.size()); }

  [[nodiscard]] std::string place(std::string const& file) const {
    auto const end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size()));
    return file + ":" + std::to_string(std::count(text_.begin(), end, '\n') + 1);
  }

  std::string_view text_;
  std::size_t at_ = 0, depth_ = 0, count_ = 0;
};

}  // namespace cambium::map::detail
