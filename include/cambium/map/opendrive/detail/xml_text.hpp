#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "cambium/core/error.hpp"

namespace cambium::inline v0_1::map::detail {

/// Grows an XML text element by element, indented by two blanks a level; where an element has text, nothing is added
/// to what it holds.
class XmlText {
 public:
  XmlText() { text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"; }

  /// An element; `content` writes its attributes, then its text, then its children.
  template <class Content>
  void element(std::string_view name, Content const& content) {
    check_name(name);
    finish_tag();
    new_line();
    text_ += '<';
    text_ += name;
    is_tag_open_ = true;
    bool const was_exact = is_exact_;
    ++depth_;
    content();
    --depth_;
    if (is_tag_open_) {
      text_ += "/>";
    } else {
      new_line();
      text_ += "</";
      text_ += name;
      text_ += '>';
    }
    is_tag_open_ = false;
    is_exact_ = was_exact;
  }

  void attribute(std::string_view name, std::string_view value) {
    check_name(name);
    text_ += ' ';
    text_ += name;
    text_ += "=\"";
    add_escaped(value, true);
    text_ += '"';
  }

  void text(std::string_view text) {
    finish_tag();
    is_exact_ = true;
    bool const is_blank = text.find_first_not_of(" \t\r\n") == text.npos;
    if (!is_blank) return add_escaped(text, false);
    for (char const c : text) add_reference(c);  // a reader may drop blanks that are written as such
  }

  /// The whole text. Precondition: all elements are closed.
  [[nodiscard]] std::string take() {
    text_ += '\n';
    return std::move(text_);
  }

 private:
  void finish_tag() {
    if (is_tag_open_) text_ += '>';
    is_tag_open_ = false;
  }
  void new_line() {
    if (is_exact_) return;
    if (text_.back() != '\n') text_ += '\n';
    text_.append(2 * depth_, ' ');
  }

  static void check_name(std::string_view name) {
    bool const begins_well = !name.empty() && name.find_first_of("-.0123456789") != 0;
    if (!begins_well || name.find_first_of(" \t\r\n\"'<>&/=!?\0", 0, 14) != name.npos)
      throw MapError("\"" + std::string(name) + "\"", "XML does not allow this name for an element or attribute",
                     "name it with letters, digits, '_', '-', '.', ':'");
  }

  void add_escaped(std::string_view value, bool in_attribute) {
    for (char const c : value) {
      if (c == '&')
        text_ += "&amp;";
      else if (c == '<')
        text_ += "&lt;";
      else if (c == '>')
        text_ += "&gt;";
      else if (c == '"' && in_attribute)
        text_ += "&quot;";
      else if (c == '\r' || (in_attribute && (c == '\n' || c == '\t')))
        add_reference(c);  // a reader turns them into blanks otherwise
      else if (c >= '\0' && c < ' ' && c != '\n' && c != '\t')
        text_ += "\xEF\xBF\xBD";  // XML has no way to write them
      else
        text_ += c;
    }
  }
  void add_reference(char c) { text_ += "&#" + std::to_string(static_cast<int>(c)) + ";"; }

  std::string text_;
  std::size_t depth_ = 0;
  bool is_tag_open_ = false;
  bool is_exact_ = false;
};

}  // namespace cambium::inline v0_1::map::detail
