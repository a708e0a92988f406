#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/map.hpp"

/// Conflict zones: at which places two bodies touch, one on the corridor, the other on another lane.
///
/// Both bodies are put at places half a metre apart, as oriented boxes on the two paths; a box that
/// touches at least one box of the other lane contributes a zone from the first touched place to the last. Zones that
/// leave no room to wait between them are joined (`add_zone`). Two complications remain. A body can reach beyond the
/// end of its lane, where ways may part: then all of them count (`tracks`). And trying all pairs would be slow: from
/// the distance of two boxes follows how many places cannot touch, and these are skipped (`places_apart`).
namespace cambium::inline v0_1::map::detail {

/// Adds to `ways` all ways that continue from the end of lane `at` (`ahead`), or lead back from its begin, over `reach`
/// [m] or as far as there are lanes. `way` is the one so far.
inline void add_ways_on(Map const& map, LaneId at, bool ahead, double reach, std::vector<LaneId>& way,
                        std::vector<std::vector<LaneId>>& ways) {
  constexpr std::size_t most = 16;
  if (ways.size() == most) return;
  auto const& next = ahead ? map.lane(at).successors : map.lane(at).predecessors;
  if (reach <= 0.0 || next.empty() || way.size() == most) return ways.push_back(way);
  for (auto const id : next) {
    way.push_back(id);
    add_ways_on(map, id, ahead, reach - map.lane(id).length(), way, ways);
    way.pop_back();
  }
}

/// The pose at `s` [m] of a lane's path; beyond an end of the path, along the lanes of `way`, and where these end,
/// straight on.
[[nodiscard]] inline geometry::Pose pose_on_way(Map const& map, LaneId id, std::vector<LaneId> const& way, double s) {
  auto const* lane = &map.lane(id);
  for (std::size_t i = 0; i < way.size() && s < 0.0; ++i) {
    lane = &map.lane(way[i]);
    s += lane->length();
  }
  for (std::size_t i = 0; i < way.size() && s > lane->length(); ++i) {
    s -= lane->length();
    lane = &map.lane(way[i]);
  }
  double const on_path = std::clamp(s, 0.0, lane->length());
  auto const pose = lane->path.pose(on_path);
  if (s == on_path) return pose;
  return {pose.x + (s - on_path) * portable::cos(pose.heading), pose.y + (s - on_path) * portable::sin(pose.heading),
          pose.heading};
}

/// The smallest zone that holds both.
[[nodiscard]] inline ConflictZone joined(ConflictZone zone, ConflictZone const& with) {
  if (with.empty()) return zone;
  if (zone.empty()) return with;
  zone.begin = std::min(zone.begin, with.begin);
  zone.end = std::max(zone.end, with.end);
  zone.other_begin = std::min(zone.other_begin, with.other_begin);
  zone.other_end = std::max(zone.other_end, with.other_end);
  return zone;
}

/// Adds a zone to a list of zones with room to wait between any two of them, on both ways. Zones that are closer become
/// one, else two vehicles could each stand in a zone that the other waits for.
inline void add_zone(std::vector<ConflictZone>& zones, ConflictZone zone) {
  constexpr double room = 5.0;  // [m] for one who waits
  auto const is_one_with = [&zone](ConflictZone const& other) {
    return std::max(other.begin - zone.end, zone.begin - other.end) < room ||
           std::max(other.other_begin - zone.other_end, zone.other_begin - other.other_end) < room;
  };
  for (auto at = zones.begin(); (at = std::find_if(zones.begin(), zones.end(), is_one_with)) != zones.end();) {
    zone = joined(zone, *at);
    zones.erase(at);
  }
  zones.push_back(zone);
}

/// Finds where two bodies touch, each on its lane and the ways that lead on from it. Where ways part beyond a lane's
/// end, all of them count, for both bodies. So both sides find the same zones, except where bodies barely graze.
struct TouchingBodies {
  Map const& map;
  LaneCorridor const& corridor;  ///< of the first body
  CorridorPiece const& piece;    ///< its lane there
  LaneId other;
  geometry::Shape shape, other_shape;
  double touching_distance = shape.radius() + other_shape.radius();  ///< of centres, at most [m]

  /// The parts of `range` where they touch, apart as in `add_zone`. O(places on one times places on the other).
  [[nodiscard]] std::vector<ConflictZone> zones(ConflictZone const& range) const {
    auto const others = tracks(other, other_shape, range.other_begin, range.other_end);
    auto const branches = tracks(piece.lane, shape, range.begin + piece.lane_offset, range.end + piece.lane_offset);
    std::vector<ConflictZone> zones;
    std::size_t const count = places(range.begin, range.end);
    for (std::size_t i = 0; i < count; ++i) {
      double const s = range.begin + static_cast<double>(i) * step;
      ConflictZone touched;
      auto const add = [&](geometry::OrientedBox const& body) {
        for (auto const& track : others)
          if (track.around.contains(body.center())) add_touched(body, s, track, range.other_begin, touched);
      };
      add(geometry::box_of(shape, corridor.center.pose(s)));
      for (auto const& track : branches)
        if (track.is_branch && i >= track.first && i < track.first + track.bodies.size())
          add(track.bodies[i - track.first]);
      if (!touched.empty()) add_zone(zones, touched);
    }
    return zones;
  }

 private:
  static constexpr double step = 0.5;  // [m] between two places of a body

  /// A body at the places `first`, `first` + 1, ... of a range, along one way.
  struct Track {
    std::size_t first;
    bool is_branch;  ///< beyond the lane's end, where there are other ways too
    std::vector<geometry::OrientedBox> bodies;
    geometry::Box around;  ///< holds the centre of any body that touches one of them
  };

  [[nodiscard]] static std::size_t places(double begin, double end) {
    return end < begin ? 0 : static_cast<std::size_t>((end - begin) / step) + 1;
  }

  /// A body's places from path position `begin` to `end` of a lane: on the lane, and on all ways beyond it.
  [[nodiscard]] std::vector<Track> tracks(LaneId lane, geometry::Shape const& body, double begin, double end) const {
    double const length = map.lane(lane).length();
    std::size_t const count = places(begin, end);
    auto const place = [begin](std::size_t i) { return begin + static_cast<double>(i) * step; };
    std::size_t entered = 0;
    while (entered < count && place(entered) < 0.0) ++entered;
    std::size_t left = entered;
    while (left < count && place(left) <= length) ++left;
    std::vector<Track> tracks;
    auto const add = [&](std::vector<LaneId> const& way, std::size_t from, std::size_t to, bool is_branch) {
      if (from >= to) return;
      Track track{from, is_branch, {}, {}};
      track.bodies.reserve(to - from);
      for (auto i = from; i < to; ++i) {
        track.bodies.push_back(geometry::box_of(body, pose_on_way(map, lane, way, place(i))));
        track.around.add(track.bodies.back().x, track.bodies.back().y);
      }
      track.around = track.around.grown(touching_distance);
      tracks.push_back(std::move(track));
    };
    add({}, entered, left, false);
    for (bool const ahead : {false, true}) {
      std::vector<std::vector<LaneId>> ways;
      std::vector<LaneId> way;
      add_ways_on(map, lane, ahead, ahead ? end - length : -begin, way, ways);
      for (auto const& on : ways) add(on, ahead ? left : 0, ahead ? count : entered, ways.size() > 1);
    }
    return tracks;
  }

  /// Grows `touched` by where `body`, at `s` [m] of its corridor, touches one of the track: from the first to the last.
  void add_touched(geometry::OrientedBox const& body, double s, Track const& track, double begin,
                   ConflictZone& touched) const {
    auto const& others = track.bodies;
    auto const skip_at = [&](std::size_t i) { return places_apart(body, others[i]); };
    std::size_t first = 0;
    for (std::size_t skip = 1; first < others.size() && skip > 0; first += skip) skip = skip_at(first);
    if (first >= others.size()) return;
    std::size_t last = others.size() - 1;
    for (std::size_t skip = 1; last > first && skip > 0; last -= std::min(skip, last - first)) skip = skip_at(last);
    auto const at = [&](std::size_t i) { return begin + static_cast<double>(track.first + i) * step; };
    touched = joined(touched, {s - step, s + step, at(first) - step, at(last) + step});
  }

  /// 0 where they touch, else how many places on they may do so at the earliest: bodies go no more than 2 m along 1 m
  /// of path.
  [[nodiscard]] std::size_t places_apart(geometry::OrientedBox const& a, geometry::OrientedBox const& b) const {
    double const dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
    double const near = touching_distance + 2.0 * step;
    if (squared > near * near) return static_cast<std::size_t>((std::sqrt(squared) - touching_distance) / (2.0 * step));
    return geometry::intersects(a, b) ? 0 : 1;
  }
};

}  // namespace cambium::inline v0_1::map::detail
