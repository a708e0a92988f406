#pragma once

#include <concepts>
#include <string>
#include <string_view>
#include <vector>

namespace cambium::inline v0_1::map::opendrive {

/// A line of the file, the first is 1; 0: unknown. It says where something was written, not what: any two are equal.
struct FileLine {
  int value = 0;

  constexpr FileLine() = default;
  /// Converts from and to the number.
  constexpr FileLine(int line) : value(line) {}
  constexpr operator int() const { return value; }

  // For two lines only: with a number, a line compares as the number that it is.
  template <std::same_as<FileLine> L>
  friend constexpr bool operator==(L, L) {
    return true;
  }
};

/// An attribute of an XML element, as written.
struct Attribute {
  std::string name;
  std::string value;

  friend bool operator==(Attribute const&, Attribute const&) = default;
};

/// Any XML element, as the file has it, but for comments and for the place of the text among the children.
struct Element {
  std::string name;  ///< with its namespace prefix
  std::vector<Attribute> attributes;
  std::vector<Element> children;
  std::string text;  ///< empty when it is white space only

  friend bool operator==(Element const& a, Element const& b) {
    return a.name == b.name && a.attributes == b.attributes && a.text == b.text && a.children == b.children;
  }
};

/// What a file says in an element beyond what the document has fields for: what the library makes no use of (objects,
/// access, controllers of junctions, ...), user data, elements of later revisions, unknown words. It is kept in order
/// and written again. The rest of a mere container (`link`, `planView`, `elevationProfile`, `lateralProfile`, `lanes`,
/// `left`, `center`, `right`, `signals`) is an element of the container's name, with that rest only, in the rest of its
/// parent.
struct Rest {
  std::vector<Attribute> attributes;
  std::vector<Element> elements;

  /// The attribute of that name, null when there is none.
  [[nodiscard]] Attribute const* find_attribute(std::string_view name) const {
    for (Attribute const& attribute : attributes)
      if (attribute.name == name) return &attribute;
    return nullptr;
  }

  friend bool operator==(Rest const&, Rest const&) = default;
};

}  // namespace cambium::inline v0_1::map::opendrive
