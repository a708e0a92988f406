#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "cambium/map/building/detail/document_index.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::inline v0_1::map::detail {

/// Puts a document back as it was when this was made, unless `keep` is called: for changes that fail half way. Roads
/// and junctions may be added; existing ones may change only if they are watched.
class Rollback {
 public:
  Rollback(opendrive::Document& document, DocumentIndex const& index)
      : document_(document), index_(index), roads_(document.roads.size()), junctions_(document.junctions.size()) {}
  Rollback(Rollback const&) = delete;
  Rollback& operator=(Rollback const&) = delete;

  ~Rollback() {
    if (is_kept_) return;
    for (auto& [place, copy] : saved_roads_) document_.roads[place] = std::move(copy);
    for (auto const& [place, count] : saved_junctions_) shrink(document_.junctions[place].connections, count);
    shrink(document_.roads, roads_);
    shrink(document_.junctions, junctions_);
  }

  /// The road of that id, what its ends are linked to, and that connections are added to its junctions.
  void watch_road(std::string const& id) {
    save_road(id);
    auto const& road = index_.road(document_, id);
    watch_junction(road.junction);
    for (auto const* link : {&road.predecessor, &road.successor}) {
      if (!*link) continue;
      (*link)->element_type == opendrive::ElementType::road ? save_road((*link)->id) : watch_junction((*link)->id);
    }
  }

  /// That connections are added to the junction of that id.
  void watch_junction(std::string const& id) {
    if (auto const place = index_.find_junction(document_, id); place < junctions_)
      saved_junctions_.emplace_back(place, document_.junctions[place].connections.size());
  }

  void keep() { is_kept_ = true; }

 private:
  void save_road(std::string const& id) {
    if (auto const place = index_.find_road(document_, id); place < roads_)
      saved_roads_.emplace_back(place, document_.roads[place]);
  }
  template <class Element>
  static void shrink(std::vector<Element>& elements, std::size_t count) {
    elements.erase(elements.begin() + static_cast<std::ptrdiff_t>(count), elements.end());
  }

  opendrive::Document& document_;
  DocumentIndex const& index_;
  std::size_t roads_, junctions_;
  std::vector<std::pair<std::size_t, opendrive::RoadElement>> saved_roads_;
  std::vector<std::pair<std::size_t, std::size_t>> saved_junctions_;  ///< places, numbers of connections
  bool is_kept_ = false;
};

}  // namespace cambium::inline v0_1::map::detail
