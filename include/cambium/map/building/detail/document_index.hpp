#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::inline v0_1::map::detail {

/// Where the elements of a growing list are, by their ids.
template <class Element>
class IdIndex {
 public:
  /// Learns what was added. To be called before `contains`. O(1) each.
  void update(std::vector<Element> const& elements) {
    if (known_ > elements.size()) forget();
    for (; known_ < elements.size(); ++known_) places_.try_emplace(elements[known_].id, known_);
  }
  /// To be called where ids may have changed: the next update learns all of them anew.
  void forget() {
    places_.clear();
    known_ = 0;
  }
  [[nodiscard]] bool contains(std::string const& id) const { return places_.contains(id); }

  /// The place of the element of that id, also where the list was changed since the update, but then in O(n); the
  /// list's size where there is none.
  [[nodiscard]] std::size_t find(std::vector<Element> const& elements, std::string const& id) const {
    auto const place = places_.find(id);
    if (place != places_.end() && place->second < elements.size() && elements[place->second].id == id)
      return place->second;
    auto const found = std::find_if(elements.begin(), elements.end(), [&id](Element const& e) { return e.id == id; });
    return static_cast<std::size_t>(found - elements.begin());
  }

 private:
  std::unordered_map<std::string, std::size_t> places_;
  std::size_t known_ = 0;  ///< how many elements are in `places_`
};

/// Where the roads and junctions of a document are.
class DocumentIndex {
 public:
  using Document = opendrive::Document;

  void update(Document const& document) {
    roads_.update(document.roads);
    junctions_.update(document.junctions);
  }
  void forget() {
    roads_.forget();
    junctions_.forget();
  }
  [[nodiscard]] bool has_road(std::string const& id) const { return roads_.contains(id); }
  [[nodiscard]] bool has_junction(std::string const& id) const { return junctions_.contains(id); }

  /// Their places; the number of all where there is none of that id.
  [[nodiscard]] std::size_t find_road(Document const& document, std::string const& id) const {
    return roads_.find(document.roads, id);
  }
  [[nodiscard]] std::size_t find_junction(Document const& document, std::string const& id) const {
    return junctions_.find(document.junctions, id);
  }

  /// Throw `MapError` where there is none of that id.
  [[nodiscard]] auto& road(auto& document, std::string const& id) const {
    return at(document.roads, find_road(document, id), "road " + id);
  }
  [[nodiscard]] auto& junction(auto& document, std::string const& id) const {
    return at(document.junctions, find_junction(document, id), "junction " + id);
  }

  /// A number that no road and no junction has.
  [[nodiscard]] std::string free_id(Document const& document) {
    update(document);
    free_ = std::max(free_, document.roads.size() + 1);
    while (has_road(std::to_string(free_)) || has_junction(std::to_string(free_))) ++free_;
    return std::to_string(free_);
  }

 private:
  [[nodiscard]] static auto& at(auto& elements, std::size_t place, std::string const& where) {
    if (place == elements.size()) throw MapError(where, "there is none of that id", "add it first");
    return elements[place];
  }

  IdIndex<opendrive::RoadElement> roads_;
  IdIndex<opendrive::JunctionElement> junctions_;
  std::size_t free_ = 1;  ///< the numbers before are taken, or were
};

}  // namespace cambium::inline v0_1::map::detail
