#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/world/traffic_query.hpp"

namespace cambium {

/// A lane's range of the lane coordinate [m].
struct LaneStretch {
  double begin = 0.0, end = 0.0;
};

/// What the index keeps of agents that do not drive in the middle of a lane. Extra entries: one for each further lane
/// that an agent reaches into.
struct ReachingEntries {
  std::vector<TrafficEntry> entries;
  double over_begin = 0.0, over_end = 0.0;  ///< largest extent of an agent beyond the begin (end) of its lane [m]
  bool leaves_room = false;                 ///< an agent in its lane leaves `TrafficIndex::room_to_pass` beside itself
  std::vector<Slot> off_lanes;              ///< agents on no drivable lane of their own

  void clear() {
    entries.clear();
    over_begin = over_end = 0.0;
    leaves_room = false;
    off_lanes.clear();
  }

  void add(TrafficEntry const& entry, LaneStretch const& lane) {
    entries.push_back(entry);
    over_begin = std::max(over_begin, lane.begin - (entry.position - entry.rear));
    over_end = std::max(over_end, entry.position + entry.front - lane.end);
  }
};

/// All agents on the lanes, sorted, so that the next road user along a corridor is usually the next entry of a list.
///
/// Each lane owns a range of the map-wide lane coordinate (see `Lane::index_begin`), so one sorted list holds all
/// lanes:
///
///     lane coordinate   0 --------- lane 0 --------- 120 --------- lane 1 --------- 260 ---
///     agents                  a         b                     c   d          e
///     corridor of `a` = pieces [lane 0][lane 4]: its leader is b; the leader of b is the first entry in lane 4
///
/// The list is repaired once a step by insertion sort, because agents rarely overtake within a lane; if the order has
/// changed a lot, it is sorted anew. An agent that reaches over its lane's border has a second entry, in the
/// neighbouring lane. Static objects have a list of their own, cut into short parts.
///
/// The neighbour ahead (behind) is the road user with the smallest gap among those whose reference point is ahead of
/// (behind) the searching agent's. For objects, the middle of each part counts as the reference point. The search
/// covers the corridor and its feeders: lanes that merge in, or have just split off. Usually the next entry has the
/// smallest gap. If vehicles of different lengths stand side by side, a later entry may reach nearer (`crowded_`), and
/// the search continues as far as any vehicle reaches back.
class TrafficIndex {
 public:
  /// Updates the index for `count` agents. `entry_of(slot, list)` returns the agent's `TrafficEntry` (position
  /// +infinity: on no lane of its own) and appends its entries in other lanes to the list; `lane_of(slot)` returns the
  /// `LaneStretch` of its own lane. No allocation once warm. O(count) if the order has hardly changed.
  template <class EntryOf, class LaneOf>
  void refresh(std::size_t count, EntryOf const& entry_of, LaneOf const& lane_of) {
    if (rank_.size() != count) {
      rank_.resize(count);
      agents_.reserve(3 * count);
      reaching_.entries.reserve(2 * count);
      reaching_.off_lanes.reserve(count);
      agents_.resize(count);
      for (std::uint32_t i = 0; i < count; ++i) agents_[rank_[i] = i].slot = Slot{i};
    }
    reaching_.clear();
    Reach reach;
    std::size_t own = 0;
    for (std::size_t i = 0; i < agents_.size(); ++i) {
      if (!is_own(i)) continue;  // an extra entry of the last step
      agents_[own] = entry_of(agents_[i].slot, reaching_);
      reach.note(agents_[own++]);
    }
    for (auto const& entry : reaching_.entries) reach.note(entry);
    reach_ = reach;
    agents_.resize(count);
    sort_nearly_sorted(agents_);
    std::sort(reaching_.entries.begin(), reaching_.entries.end());
    std::sort(reaching_.off_lanes.begin(), reaching_.off_lanes.end());
    merge_reaching(count);
    crowded_ = !reach_.all_alike() && anybody_hides(lane_of);
  }

  /// The road user of an entry, at gap `gap` [m] and corridor position `s` [m].
  [[nodiscard]] static RoadUser user_of(TrafficEntry const& e, bool is_object, double gap, double s) {
    return {.agent = is_object ? none<AgentId> : static_cast<AgentId>(e.id),
            .object = is_object ? static_cast<ObjectId>(e.id) : none<ObjectId>,
            .slot = e.slot,
            .gap = gap,
            .s = s,
            .front = e.front,
            .rear = e.rear,
            .speed = e.speed};
  }

  /// Whether the agent has an entry in its own lane.
  [[nodiscard]] bool has(Slot slot) const {
    return agents_[rank_[index_of(slot)]].position < std::numeric_limits<double>::infinity();
  }

  /// Free width [m] beside an agent in its lane from which on another one might pass it there: a bicycle's, with 1.3 m.
  static constexpr double room_to_pass = 2.0;

  /// Whether an agent drives aside from the middle of its lane and leaves `room_to_pass` beside itself.
  [[nodiscard]] bool anybody_leaves_room() const { return reaching_.leaves_room; }

  /// The agents on no drivable lane of their own, such as pedestrians on free corridors, in the order of their slots.
  /// An agent in the middle of a sidewalk or another lane that is not drivable is not among them.
  [[nodiscard]] std::span<Slot const> off_lanes() const { return reaching_.off_lanes; }

  /// Next road user ahead on `corridor`. `own` says that the searching agent's own entry lies on this corridor's piece,
  /// which saves a binary search.
  template <class Query>
  [[nodiscard]] std::optional<RoadUser> front(map::LaneCorridor const& corridor, Query const& query,
                                              std::span<TrafficEntry const> objects, bool own) const {
    return front_from(own ? rank_[index_of(query.slot)] + 1 : upper(agents(), key(corridor, query), query.slot),
                      corridor, query, objects);
  }

  /// Calls `f(RoadUser)` for the next road user ahead on `corridor` itself, then for the next one on each of its
  /// feeders; `own` as in `front`.
  template <class Query, class F>
  void each_front(map::LaneCorridor const& corridor, Query const& query, std::span<TrafficEntry const> objects,
                  bool own, F&& f) const {
    auto const start = own ? rank_[index_of(query.slot)] + 1 : upper(agents(), key(corridor, query), query.slot);
    Nearest best;
    front_on_corridor(corridor, query, start, best);
    if (crowded_ || !objects.empty()) best = front_in_crowd(start, corridor, query, objects, best);
    if (best.entry) f(*hit(best, objects));
    for (auto const& feeder : corridor.feeders) {
      if (feeder.begin > query.s + query.distance) break;
      Nearest next;
      front_on_feeder(feeder, query, objects, next);
      if (next.entry) f(*hit(next, objects));
    }
  }

  /// Next road user behind on `corridor`; `own` as in `front`.
  template <class Query>
  [[nodiscard]] std::optional<RoadUser> rear(map::LaneCorridor const& corridor, Query const& query,
                                             std::span<TrafficEntry const> objects, bool own) const {
    return rear_from(own ? rank_[index_of(query.slot)] : lower(agents(), key(corridor, query), query.slot), corridor,
                     query, objects);
  }

  /// The query's position in the list of agents: one search that serves `front_from` and `rear_from`. O(log n).
  [[nodiscard]] std::size_t find(map::LaneCorridor const& corridor, TrafficQuery const& query) const {
    return lower(agents(), key(corridor, query), query.slot);
  }

  /// Calls `f(entry, is_object)` for every road user that reaches into lane coordinates `begin` to `end` of one lane,
  /// also from another lane: agents in the order of their positions, then objects. O(log n + road users near).
  template <class F>
  void for_each_in(double begin, double end, std::span<TrafficEntry const> objects, F&& f) const {
    auto const visit = [&](List list, bool is_object) {
      if (list.empty()) return;
      double const longest = is_object ? longest_object : std::max(reach_.longest_front, reach_.longest_rear);
      auto const* const last = list.data() + list.size();
      for (auto const* e = first_entry(list, begin - longest); e != last && e->position <= end + longest; ++e)
        if (e->position + e->front >= begin && e->position - e->rear <= end) f(*e, is_object);
    };
    visit(agents(), false);
    visit(objects, true);
  }

  /// Next road user ahead; entry `start` of the agents is the first candidate on the query's piece.
  template <class Query>
  [[nodiscard]] std::optional<RoadUser> front_from(std::size_t start, map::LaneCorridor const& corridor,
                                                   Query const& query, std::span<TrafficEntry const> objects) const {
    Nearest best;
    front_on_corridor(corridor, query, start, best);
    if (crowded_ || !objects.empty() || !corridor.feeders.empty())
      best = front_of_others(start, corridor, Query(query), objects, best);
    return hit(best, objects);
  }

  /// Next road user behind; the candidates among the agents lie before entry `start`.
  template <class Query>
  [[nodiscard]] std::optional<RoadUser> rear_from(std::size_t start, map::LaneCorridor const& corridor,
                                                  Query const& query, std::span<TrafficEntry const> objects) const {
    Nearest best;
    rear_on_corridor(corridor, query, start, best);
    if (crowded_ || !objects.empty() || !corridor.feeders.empty())
      best = rear_of_others(start, corridor, Query(query), objects, best);
    return hit(best, objects);
  }

  /// The foremost agent in the lanes that merge into `corridor` at `merge`, measured by its image on the corridor and
  /// not beyond `limit`. Ignores agents that `query` skips. O(feeders), plus a search in each.
  template <class Query>
  [[nodiscard]] std::optional<RoadUser> merging(map::LaneCorridor const& corridor, double merge, double limit,
                                                Query const& query) const {
    TrafficEntry const* best = nullptr;
    double best_s = -std::numeric_limits<double>::infinity();
    for (auto const& feeder : corridor.feeders) {
      if (feeder.free_until != merge || !feeder.is_still_to_merge() || feeder.begin > limit) continue;
      double const to = limit >= feeder.end ? feeder.index_end : feeder.index_at(limit);
      for (auto i = upper(agents(), to, none<Slot>); i > 0 && agents_[i - 1].position >= feeder.index_begin; --i) {
        auto const& entry = agents_[i - 1];
        if (!is_own(i - 1)) continue;
        double const s = feeder.image(entry.position);
        if (query.skips(entry, std::abs(s - query.s))) continue;
        if (!best || s > best_s) {
          best = &entry;
          best_s = s;
        }
        break;
      }
    }
    if (!best) return std::nullopt;
    return user_of(*best, false, best_s - best->rear - (query.s + query.front), best_s);
  }

 private:
  using List = std::span<TrafficEntry const>;

  [[nodiscard]] List agents() const { return {agents_.data(), size_}; }

  /// Largest length of an object's part [m].
  static constexpr double longest_object = 10.0;

  /// Bounds of the agents' extents in front of and behind their reference points [m].
  struct Reach {
    double longest_front = 0.0, longest_rear = 0.0;
    double shortest_front = std::numeric_limits<double>::infinity();
    double shortest_rear = std::numeric_limits<double>::infinity();

    void note(TrafficEntry const& entry) {
      longest_front = std::max(longest_front, entry.front);
      longest_rear = std::max(longest_rear, entry.rear);
      shortest_front = std::min(shortest_front, entry.front);
      shortest_rear = std::min(shortest_rear, entry.rear);
    }

    [[nodiscard]] bool all_alike() const { return !(shortest_front < longest_front || shortest_rear < longest_rear); }
  };

  /// The nearest entry so far: small enough to stay in registers.
  struct Nearest {
    double gap = std::numeric_limits<double>::infinity();  ///< [m]
    double s{};                                            ///< on the corridor [m]
    TrafficEntry const* entry = nullptr;

    void offer(TrafficEntry const& other, double other_s, double other_gap) {
      if (other_gap < gap) *this = {other_gap, other_s, &other};
    }
  };

  [[nodiscard]] static std::optional<RoadUser> hit(Nearest const& best, List objects) {
    if (!best.entry) return std::nullopt;
    auto const& e = *best.entry;
    bool const is_object = !objects.empty() && !std::less{}(best.entry, objects.data()) &&
                           std::less{}(best.entry, objects.data() + objects.size());
    return user_of(e, is_object, best.gap, best.s);
  }

  template <class Query>
  [[nodiscard]] static bool skips(Query const& query, TrafficEntry const& entry, bool is_object, double distance) {
    return is_object ? query.skips_object(entry, distance) : query.skips(entry, distance);
  }

  template <class Query>
  [[nodiscard]] static double key(map::LaneCorridor const& corridor, Query const& query) {
    auto const& piece = corridor.pieces[query.piece];  // other lanes own the coordinates beyond the corridor's ends
    return std::min(std::max(query.s, piece.begin - 1.0), piece.end + 1.0) + piece.index_offset;
  }

  /// First entry that sorts after (position, slot).
  [[nodiscard]] static std::size_t upper(List list, double position, Slot slot) {
    auto i = first_at(list, position);
    while (i < list.size() && list[i].position == position && list[i].slot <= slot) ++i;
    return i;
  }
  /// First entry that does not sort before (position, slot).
  [[nodiscard]] static std::size_t lower(List list, double position, Slot slot) {
    auto i = first_at(list, position);
    while (i < list.size() && list[i].position == position && list[i].slot < slot) ++i;
    return i;
  }

  /// First entry at or beyond `position`.
  [[nodiscard]] static std::size_t first_at(List list, double position) {
    return static_cast<std::size_t>(first_entry(list, position) - list.data());
  }
  /// The same as a pointer: a binary search without unpredictable branches.
  [[nodiscard]] static TrafficEntry const* first_entry(List list, double position) {
    TrafficEntry const* base = list.data();
    std::size_t left = list.size();
    if (left == 0) return base;
    while (left > 1) {
      std::size_t const half = left / 2;
      TrafficEntry const* const middle = base + half;
      base = middle[-1].position < position ? middle : base;
      left -= half;
    }
    return base + (base->position < position ? 1 : 0);
  }

  /// Next agent ahead on the corridor by reference point.
  template <class Query>
  void front_on_corridor(map::LaneCorridor const& corridor, Query const& query, std::size_t start,
                         Nearest& best) const {
    auto const list = agents();
    auto const& pieces = corridor.pieces;
    for (std::size_t p = index_of(query.piece), i = start;;) {
      while (i < list.size() && query.skips(list[i], list[i].position - pieces[p].index_offset - query.s))
        ++i;  // the searching agent's own entry in another lane
      if (i < list.size() && list[i].position <= pieces[p].end + 1.0 + pieces[p].index_offset) {
        double const s = list[i].position - pieces[p].index_offset;
        if (s - query.s <= query.distance) best.offer(list[i], s, s - list[i].rear - (query.s + query.front));
        return;
      }
      if (++p == pieces.size() || pieces[p].begin - query.s > query.distance) return;
      i = first_at(list, pieces[p].begin - 1.0 + pieces[p].index_offset);
    }
  }

  template <class Query>
  void rear_on_corridor(map::LaneCorridor const& corridor, Query const& query, std::size_t start, Nearest& best) const {
    auto const list = agents();
    auto const& pieces = corridor.pieces;
    for (std::size_t p = index_of(query.piece), i = start;;) {  // candidates lie before i
      while (i > 0 && query.skips(list[i - 1], query.s - (list[i - 1].position - pieces[p].index_offset))) --i;
      if (i > 0 && list[i - 1].position >= pieces[p].begin - 1.0 + pieces[p].index_offset) {
        auto const& entry = list[i - 1];
        double const s = entry.position - pieces[p].index_offset;
        if (query.s - s <= query.distance) best.offer(entry, s, query.s - query.rear - (s + entry.front));
        return;
      }
      if (p-- == 0 || query.s - pieces[p].end > query.distance) return;
      i = upper(list, pieces[p].end + 1.0 + pieces[p].index_offset, none<Slot>);
    }
  }

  /// Smallest gap ahead on the corridor, even if another entry is next by reference point: searches on as far as any
  /// entry can reach back, at most `longest` [m].
  template <class Query>
  static void nearest_front(List list, bool is_object, double longest, map::LaneCorridor const& corridor,
                            Query const& query, std::size_t start, Nearest& best) {
    auto const& pieces = corridor.pieces;
    double const own_front = query.s + query.front;
    for (std::size_t p = index_of(query.piece), i = start; p < pieces.size(); ++p) {
      double const offset = pieces[p].index_offset, from = pieces[p].begin - 1.0;
      if (p > index_of(query.piece)) {
        if (from - longest - own_front >= best.gap || from - query.s > query.distance) return;
        i = first_at(list, from + offset);
      }
      for (; i < list.size() && list[i].position <= pieces[p].end + 1.0 + offset; ++i) {
        double const s = list[i].position - offset;
        if (s - longest - own_front >= best.gap || s - query.s > query.distance) return;
        if (!skips(query, list[i], is_object, s - query.s)) best.offer(list[i], s, s - list[i].rear - own_front);
      }
    }
  }

  /// The counterpart behind.
  template <class Query>
  static void nearest_rear(List list, bool is_object, double longest, map::LaneCorridor const& corridor,
                           Query const& query, std::size_t start, Nearest& best) {
    auto const& pieces = corridor.pieces;
    double const own_rear = query.s - query.rear;
    for (std::size_t p = index_of(query.piece) + 1, i = start; p-- > 0;) {  // candidates lie before i
      double const offset = pieces[p].index_offset, to = pieces[p].end + 1.0;
      if (p < index_of(query.piece)) {
        if (own_rear - (to + longest) >= best.gap || query.s - to > query.distance) return;
        i = upper(list, to + offset, none<Slot>);
      }
      for (; i > 0 && list[i - 1].position >= pieces[p].begin - 1.0 + offset; --i) {
        auto const& entry = list[i - 1];
        double const s = entry.position - offset;
        if (own_rear - (s + longest) >= best.gap || query.s - s > query.distance) return;
        if (!skips(query, entry, is_object, query.s - s)) best.offer(entry, s, own_rear - (s + entry.front));
      }
    }
  }

  /// Next road user ahead among static objects on the corridor; if `crowded_`, also among agents farther away by
  /// reference point that may reach nearer.
  template <class Query>
  [[nodiscard]] Nearest front_in_crowd(std::size_t start, map::LaneCorridor const& corridor, Query const& query,
                                       List objects, Nearest best) const {
    if (crowded_ && best.entry) nearest_front(agents(), false, reach_.longest_rear, corridor, query, start, best);
    if (!objects.empty())
      nearest_front(objects, true, longest_object, corridor, query, upper(objects, key(corridor, query), Slot{}), best);
    return best;
  }

  /// Likewise, and among road users on feeders. Not inlined, because it is large and rarely needed; `query` is a copy,
  /// so that the caller's can stay in registers.
  template <class Query>
  CAMBIUM_NOINLINE Nearest front_of_others(std::size_t start, map::LaneCorridor const& corridor, Query const& query,
                                           List objects, Nearest best) const {
    best = front_in_crowd(start, corridor, query, objects, best);
    for (auto const& feeder : corridor.feeders) {
      if (feeder.begin > query.s + std::min(query.distance, best.gap + query.front + reach_.longest_rear) &&
          objects.empty())
        break;  // no agent there is closer
      if (feeder.begin > query.s + query.distance) break;
      front_on_feeder(feeder, query, objects, best);
    }
    return best;
  }

  /// The counterpart behind.
  template <class Query>
  CAMBIUM_NOINLINE Nearest rear_of_others(std::size_t start, map::LaneCorridor const& corridor, Query const& query,
                                          List objects, Nearest best) const {
    if (crowded_ && best.entry) nearest_rear(agents(), false, reach_.longest_front, corridor, query, start, best);
    if (!objects.empty())
      nearest_rear(objects, true, longest_object, corridor, query, lower(objects, key(corridor, query), Slot{}), best);
    for (auto const& feeder : corridor.feeders) {
      if (feeder.begin > query.s) break;
      if (feeder.end < query.s - std::min(query.distance, best.gap + query.rear + reach_.longest_front) &&
          objects.empty())
        continue;  // no agent there is closer
      if (feeder.end < query.s - query.distance || (query.merging == Merging::ignored && feeder.is_still_to_merge()))
        continue;
      rear_on_feeder(agents(), false, feeder, query, best);
      if (!objects.empty()) rear_on_feeder(objects, true, feeder, query, best);
    }
    return best;
  }

  /// Next road user ahead on a feeder, if the query looks there.
  template <class Query>
  void front_on_feeder(map::Feeder const& feeder, Query const& query, List objects, Nearest& best) const {
    if (feeder.end < query.s || (query.merging == Merging::ignored && feeder.is_still_to_merge())) return;
    front_on_feeder(agents(), false, feeder, query, best);
    if (!objects.empty()) front_on_feeder(objects, true, feeder, query, best);
  }

  template <class Query>
  void front_on_feeder(List list, bool is_object, map::Feeder const& feeder, Query const& query, Nearest& best) const {
    double const longest = is_object ? longest_object : reach_.longest_rear;
    double const from = query.s <= feeder.begin ? feeder.index_begin : feeder.index_at(query.s);
    // Rounding of the mapping must not lose an entry: start early, then skip entries that are not ahead.
    auto const* const last = list.data() + list.size();
    for (auto const* e = first_entry(list, from - 1e-6); e != last && e->position <= feeder.index_end; ++e) {
      auto const& entry = *e;
      if (entry.position < feeder.index_begin) continue;
      double const s = feeder.image(entry.position);
      if (skips(query, entry, is_object, s - query.s)) continue;
      if (query.merging == Merging::by_rule && feeder.is_up_to_rule(s + entry.front)) continue;
      bool const ahead = s > query.s || (s == query.s && entry.slot > query.slot);
      if (!ahead) continue;
      double const own_front = query.s + query.front;
      if (s - query.s > query.distance || map::gap_before_merge(own_front, s - longest, feeder.free_until) >= best.gap)
        return;
      best.offer(entry, s, map::gap_before_merge(own_front, s - entry.rear, feeder.free_until));
    }
  }

  template <class Query>
  void rear_on_feeder(List list, bool is_object, map::Feeder const& feeder, Query const& query, Nearest& best) const {
    double const longest = is_object ? longest_object : reach_.longest_front;
    double const to = query.s >= feeder.end ? feeder.index_end : feeder.index_at(query.s);
    for (auto i = upper(list, to + 1e-6, none<Slot>); i > 0 && list[i - 1].position >= feeder.index_begin; --i) {
      auto const& entry = list[i - 1];
      if (entry.position > feeder.index_end) continue;
      double const s = feeder.image(entry.position);
      if (skips(query, entry, is_object, query.s - s)) continue;
      if (query.merging == Merging::by_rule && feeder.is_up_to_rule(s + entry.front)) continue;
      bool const behind = s < query.s || (s == query.s && entry.slot < query.slot);
      if (!behind) continue;
      double const own_rear = query.s - query.rear;
      if (query.s - s > query.distance || map::gap_before_merge(s + longest, own_rear, feeder.free_until) >= best.gap)
        return;
      best.offer(entry, s, map::gap_before_merge(s + entry.front, own_rear, feeder.free_until));
    }
  }

  /// Whether entry `i` lies in its agent's own lane, not in another lane that the agent reaches into.
  [[nodiscard]] bool is_own(std::size_t i) const { return rank_[index_of(agents_[i].slot)] == i; }

  /// Whether an agent may be farther away by reference point than another one, but reach nearer. Then two consecutive
  /// entries of the list show it, or an agent reaches beyond an end of its lane farther than the shortest agent would.
  template <class LaneOf>
  [[nodiscard]] bool anybody_hides(LaneOf const& lane_of) const {
    auto const list = agents();
    auto const hides = [](TrafficEntry const& behind, TrafficEntry const& ahead) {
      return ahead.position - ahead.rear < behind.position - behind.rear ||
             ahead.position + ahead.front < behind.position + behind.front;
    };
    if (std::adjacent_find(list.begin(), list.end(), hides) != list.end()) return true;
    double const short_front = reach_.shortest_front, short_rear = reach_.shortest_rear;
    if (reaching_.over_begin > short_rear || reaching_.over_end > short_front) return true;
    for (std::size_t i = 0; i < size_; ++i) {
      auto const& e = list[i];
      if (!(e.front > short_front || e.rear > short_rear) || !is_own(i) || !has(e.slot)) continue;
      auto const lane = lane_of(e.slot);
      if (lane.begin - (e.position - e.rear) > short_rear || e.position + e.front - lane.end > short_front) return true;
    }
    return false;
  }

  /// Merges the extra entries into the first `count`, from the back, and records each agent's rank.
  void merge_reaching(std::size_t count) {
    auto const& reaching = reaching_.entries;
    auto left = reaching.size();
    agents_.resize(count + left);
    size_ = count + left;
    for (std::size_t i = count; i > 0; --i) {
      auto const& entry = agents_[i - 1];
      for (; left > 0 && !(reaching[left - 1] < entry); --left) agents_[i - 1 + left] = reaching[left - 1];
      if (left > 0) agents_[i - 1 + left] = entry;
      rank_[index_of(entry.slot)] = static_cast<std::uint32_t>(i - 1 + left);
    }
    while (left-- > 0) agents_[left] = reaching[left];
  }

  /// Insertion sort: linear if the order has hardly changed. Switches to a full sort after too many moves.
  static void sort_nearly_sorted(std::vector<TrafficEntry>& list) {
    std::size_t moves = 0;
    for (std::size_t i = 1; i < list.size(); ++i) {
      if (!(list[i] < list[i - 1])) continue;
      auto const entry = list[i];
      std::size_t j = i;
      for (; j > 0 && entry < list[j - 1]; --j) list[j] = list[j - 1];
      list[j] = entry;
      if ((moves += i - j) > 64 + 8 * list.size()) {
        std::sort(list.begin(), list.end());
        return;
      }
    }
  }

  std::vector<TrafficEntry> agents_;
  std::size_t size_ = 0;  ///< size of `agents_`, stored because `vector::size` divides
  bool crowded_ = false;  ///< a later entry may reach nearer: see `anybody_hides`
  ReachingEntries reaching_;
  std::vector<std::uint32_t> rank_;
  Reach reach_;
};

}  // namespace cambium
