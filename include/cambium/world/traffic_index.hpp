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

#include "cambium/behavior/law/gap_before_merge.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/world/detail/traffic_walk.hpp"
#include "cambium/world/traffic_query.hpp"

namespace cambium::inline v0_1 {

/// A lane's range of the lane coordinate [m].
struct LaneStretch {
  double begin = 0.0, end = 0.0;
};

/// What the index keeps of agents that do not drive in the middle of a lane. Extra entries: one for each further lane
/// that an agent reaches into.
struct ReachingEntries {
  std::vector<TrafficEntry> entries;
  double over_begin = 0.0, over_end = 0.0;  ///< largest extent of an agent beyond the begin (end) of its lane [m]
  std::vector<Slot> aside;      ///< agents that leave `TrafficIndex::room_to_pass` beside them in their lane
  std::vector<Slot> off_lanes;  ///< agents on no drivable lane of their own

  void clear() {
    entries.clear();
    over_begin = over_end = 0.0;
    aside.clear();
    off_lanes.clear();
  }

  /// Adds an agent that reaches into `lane`, and notes whether it leaves room beside itself.
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
/// covers the corridor and its feeders: lanes that merge in, or have just split off. People on foot do not merge.
/// Usually the next entry has the smallest gap. If vehicles of different lengths stand side by side, a later entry may
/// reach nearer (`crowded_`), and the search continues as far as any vehicle reaches back.
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
    for (std::size_t i = 0, listed = agents_.size(); i < listed; ++i) {
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
    cells_ = 0;
  }

  /// Prepares for many searches before the next `refresh`: they find their first entry in O(1) if the entries spread
  /// over the lanes. The same answers. No allocation once warm. O(agents).
  void expect_searches() {
    constexpr std::size_t few = 16;  // a search among them is as fast
    if (agents_.capacity() < few) return;
    first_in_cell_.reserve(2 * agents_.capacity() + 1);  // once, however many entries there are
    std::size_t placed = size_;
    while (placed > 0 && !(agents_[placed - 1].position < std::numeric_limits<double>::infinity())) --placed;
    if (placed < few || !(agents_[placed - 1].position > agents_[0].position)) return;
    std::size_t const cells = 2 * placed;
    first_in_cell_.resize(cells + 1);
    first_position_ = agents_[0].position;
    cells_per_meter_ = static_cast<double>(cells) / (agents_[placed - 1].position - first_position_);
    cells_ = cells;
    std::size_t cell = 0;
    for (std::size_t i = 0; i < placed; ++i)
      for (auto const own = cell_of(agents_[i].position); cell <= own; ++cell)
        first_in_cell_[cell] = static_cast<std::uint32_t>(i);
    for (; cell < cells; ++cell) first_in_cell_[cell] = static_cast<std::uint32_t>(placed);
    first_in_cell_[cells] = static_cast<std::uint32_t>(size_);
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

  /// The agents that drive aside from the middle of their lane and leave `room_to_pass` beside themselves.
  [[nodiscard]] std::span<Slot const> aside() const { return reaching_.aside; }

  /// The agents on no drivable lane of their own, such as pedestrians on free corridors, in the order of their slots.
  /// An agent in the middle of a sidewalk or another lane that is not drivable is not among them.
  [[nodiscard]] std::span<Slot const> off_lanes() const { return reaching_.off_lanes; }

  /// Next road user on `corridor`, ahead (`sign` 1) or behind (-1). `own` says that the searching agent's own entry
  /// lies on this corridor's piece, which saves a binary search.
  template <int sign, class Query>
  [[nodiscard]] std::optional<RoadUser> next(map::LaneCorridor const& corridor, Query const& query,
                                             std::span<TrafficEntry const> objects, bool own) const {
    auto const start = start_of<sign>(corridor, query, own);
    Nearest best;
    next_on_corridor<sign>(corridor, query, start, best);
    if (crowded_ || !objects.empty() || !corridor.feeders.empty())
      best = next_of_others<sign>(start, corridor, Query(query), objects, best);
    return hit(best, objects);
  }

  /// Calls `f(RoadUser)` for the next road user ahead on `corridor` itself, then for the next one on each of its
  /// feeders; `own` as in `next`.
  template <class Query, class F>
  void each_front(map::LaneCorridor const& corridor, Query const& query, std::span<TrafficEntry const> objects,
                  bool own, F&& f) const {
    auto const start = start_of<1>(corridor, query, own);
    Nearest best;
    next_on_corridor<1>(corridor, query, start, best);
    if (crowded_ || !objects.empty()) nearest_in_crowd<1>(start, corridor, query, objects, best);
    if (best.entry) f(*hit(best, objects));
    for (auto const& feeder : corridor.feeders) {
      if (feeder.begin > query.s + query.distance) break;
      Nearest next;
      next_on_feeder<1>(feeder, query, objects, next);
      if (next.entry) f(*hit(next, objects));
    }
  }

  /// Calls `f(entry, is_object)` for every road user that reaches into lane coordinates `begin` to `end` of one lane,
  /// also from another lane: agents in the order of their positions, then objects. O(log n + road users near).
  template <class F>
  void for_each_in(double begin, double end, std::span<TrafficEntry const> objects, F&& f) const {
    auto const visit = [&](List list, bool is_object) {
      if (list.empty()) return;
      double const longest = is_object ? longest_object : std::max(reach_.longest_front, reach_.longest_rear);
      for (auto walk = walk_from<1>(list, is_object, begin - longest); walk && walk->position <= end + longest; ++walk)
        if (walk->position + walk->front >= begin && walk->position - walk->rear <= end) f(*walk, is_object);
    };
    visit(agents(), false);
    visit(objects, true);
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
      for (auto walk = Walk<-1>::from(agents(), to); walk && walk->position >= feeder.index_begin; ++walk) {
        auto const& entry = *walk;
        if (!is_own(walk.at - 1)) continue;
        double const s = feeder.image(entry.position);
        if (query.skips(entry, false, std::abs(s - query.s))) continue;
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
  using List = detail::TrafficList;
  template <int sign>
  using Walk = detail::TrafficWalk<sign>;

  [[nodiscard]] List agents() const { return {agents_.data(), size_}; }

  /// The cell of a position, for entries in the order of their positions in that order, too.
  [[nodiscard]] std::size_t cell_of(double position) const {
    double const cell = (position - first_position_) * cells_per_meter_;
    if (!(cell > 0.0)) return 0;
    return cell < static_cast<double>(cells_) ? static_cast<std::size_t>(cell) : cells_ - 1;
  }

  /// `Walk::from` in one of the two lists.
  template <int sign>
  [[nodiscard]] Walk<sign> walk_from(List list, bool is_object, double position) const {
    if (is_object || cells_ == 0) return Walk<sign>::from(list, position);
    auto const cell = cell_of(position);
    std::size_t const begin = first_in_cell_[cell], end = first_in_cell_[cell + 1];
    auto at = begin + detail::first_at(list.subspan(begin, end - begin), position);
    if (sign < 0)
      while (at < size_ && list[at].position == position) ++at;
    return {list, at};
  }

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

  template <int sign, class Query>
  [[nodiscard]] std::size_t start_of(map::LaneCorridor const& corridor, Query const& query, bool own) const {
    if (own) return rank_[index_of(query.slot)] + (sign > 0 ? 1u : 0u);
    return Walk<sign>::start(agents(), key(corridor, query), query.slot);
  }
  /// How far any agent reaches towards a searching one [m].
  template <int sign>
  [[nodiscard]] double longest_back() const {
    return sign > 0 ? reach_.longest_rear : reach_.longest_front;
  }
  /// The gap [m] to something at `s` that reaches `back` towards the searching agent; likewise on a feeder.
  template <int sign, class Query>
  [[nodiscard]] static double gap_to(double s, double back, Query const& query) {
    return sign > 0 ? s - back - (query.s + query.front) : query.s - query.rear - (s + back);
  }
  template <int sign, class Query>
  [[nodiscard]] static double gap_to(double s, double back, Query const& query, map::Feeder const& feeder) {
    return sign > 0 ? gap_before_merge(query.s + query.front, s - back, feeder.free_until)
                    : gap_before_merge(s + back, query.s - query.rear, feeder.free_until);
  }

  template <class Query>
  [[nodiscard]] static double key(map::LaneCorridor const& corridor, Query const& query) {
    auto const& piece = corridor.pieces[query.piece];  // other lanes own the coordinates beyond the corridor's ends
    return std::min(std::max(query.s, piece.begin - 1.0), piece.end + 1.0) + piece.index_offset;
  }

  /// Next agent on the corridor by reference point.
  template <int sign, class Query>
  void next_on_corridor(map::LaneCorridor const& corridor, Query const& query, std::size_t start, Nearest& best) const {
    auto const* piece = &corridor.pieces[query.piece];
    auto const* const last = sign > 0 ? &corridor.pieces.back() : &corridor.pieces.front();
    for (Walk<sign> walk{agents(), start};; walk = Walk<sign>::into(agents(), *piece)) {
      for (; walk && walk.is_within(*piece); ++walk) {
        double const s = walk->position - piece->index_offset, way = sign * (s - query.s);
        if (query.skips(*walk, false, way)) continue;  // such as the searching agent's own entry in another lane
        if (way <= query.distance) best.offer(*walk, s, gap_to<sign>(s, walk.reach_back(), query));
        return;
      }
      if (piece == last) return;
      piece += sign;
      if ((sign > 0 ? piece->begin - query.s : query.s - piece->end) > query.distance) return;
    }
  }

  /// Smallest gap on the corridor, even if another entry is next by reference point: searches on as far as any entry
  /// can reach back, at most `longest` [m].
  template <int sign, class Query>
  static void nearest(List list, bool is_object, double longest, map::LaneCorridor const& corridor, Query const& query,
                      std::size_t start, Nearest& best) {
    auto const is_beyond = [&](double s) {
      return gap_to<sign>(s, longest, query) >= best.gap || sign * (s - query.s) > query.distance;
    };
    auto const* piece = &corridor.pieces[query.piece];
    auto const* const last = sign > 0 ? &corridor.pieces.back() : &corridor.pieces.front();
    for (Walk<sign> walk{list, start};; walk = Walk<sign>::into(list, *piece)) {
      for (; walk && walk.is_within(*piece); ++walk) {
        double const s = walk->position - piece->index_offset;
        if (is_beyond(s)) return;
        if (!query.skips(*walk, is_object, sign * (s - query.s)))
          best.offer(*walk, s, gap_to<sign>(s, walk.reach_back(), query));
      }
      if (piece == last) return;
      piece += sign;
      if (is_beyond(sign > 0 ? piece->begin - 1.0 : piece->end + 1.0)) return;
    }
  }

  /// The nearest among static objects on the corridor; if `crowded_`, also among agents farther away by reference point
  /// that may reach nearer.
  template <int sign, class Query>
  void nearest_in_crowd(std::size_t start, map::LaneCorridor const& corridor, Query const& query, List objects,
                        Nearest& best) const {
    if (crowded_ && best.entry) nearest<sign>(agents(), false, longest_back<sign>(), corridor, query, start, best);
    if (!objects.empty())
      nearest<sign>(objects, true, longest_object, corridor, query,
                    Walk<sign>::start(objects, key(corridor, query), Slot{}), best);
  }

  /// Likewise, and among road users on feeders. Not inlined, because it is large and rarely needed; `query` is a copy,
  /// so that the caller's can stay in registers.
  template <int sign, class Query>
  CAMBIUM_NOINLINE Nearest next_of_others(std::size_t start, map::LaneCorridor const& corridor, Query const& query,
                                          List objects, Nearest best) const {
    nearest_in_crowd<sign>(start, corridor, query, objects, best);
    double const own = sign > 0 ? query.front : query.rear;
    for (auto const& feeder : corridor.feeders) {
      if (sign < 0 && feeder.begin > query.s) break;
      double const reach = objects.empty() ? std::min(query.distance, best.gap + own + longest_back<sign>())
                                           : query.distance;  // no agent there is closer
      if (sign > 0 && feeder.begin > query.s + reach) break;
      if (sign > 0 || !(feeder.end < query.s - reach)) next_on_feeder<sign>(feeder, query, objects, best);
    }
    return best;
  }

  /// Next road user on a feeder, if the query looks there.
  template <int sign, class Query>
  void next_on_feeder(map::Feeder const& feeder, Query const& query, List objects, Nearest& best) const {
    if (sign > 0 && feeder.end < query.s) return;
    if (query.merging == Merging::ignored && feeder.is_still_to_merge()) return;
    next_on_feeder<sign>(agents(), false, feeder, query, best);
    if (!objects.empty()) next_on_feeder<sign>(objects, true, feeder, query, best);
  }

  template <int sign, class Query>
  void next_on_feeder(List list, bool is_object, map::Feeder const& feeder, Query const& query, Nearest& best) const {
    double const longest = is_object ? longest_object : longest_back<sign>();
    bool const is_outside = sign > 0 ? query.s <= feeder.begin : query.s >= feeder.end;
    double const from = !is_outside ? feeder.index_at(query.s) : sign > 0 ? feeder.index_begin : feeder.index_end;
    // Rounding of the mapping must not lose an entry: start early, then skip entries on the other side.
    for (auto walk = walk_from<sign>(list, is_object, from - sign * 1e-6); walk; ++walk) {
      auto const& entry = *walk;
      if (sign > 0 ? entry.position > feeder.index_end : entry.position < feeder.index_begin) return;
      if (sign > 0 ? entry.position < feeder.index_begin : entry.position > feeder.index_end) continue;
      double const s = feeder.image(entry.position), way = sign * (s - query.s);
      if (query.skips(entry, is_object, way)) continue;
      if (query.merging == Merging::by_rule && feeder.is_up_to_rule(s + entry.front)) continue;
      if (!is_object && feeder.is_still_to_merge() && is_on_foot(entry)) continue;
      bool const is_later = sign > 0 ? entry.slot > query.slot : entry.slot < query.slot;
      if (!(way > 0.0 || (way == 0.0 && is_later))) continue;
      if (way > query.distance || gap_to<sign>(s, longest, query, feeder) >= best.gap) return;
      best.offer(entry, s, gap_to<sign>(s, walk.reach_back(), query, feeder));
    }
  }

  /// Whether somebody crosses the lane that it is in, and does not merge. O(log n).
  [[nodiscard]] bool is_on_foot(TrafficEntry const& entry) const {
    return entry.front + entry.rear <= geometry::longest_on_foot &&
           std::binary_search(reaching_.off_lanes.begin(), reaching_.off_lanes.end(), entry.slot);
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
      moves += i - j;
      if (moves > 64 + 8 * list.size()) {
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
  std::size_t cells_ = 0;                     ///< equal parts of the lane coordinate between the outermost agents
  std::vector<std::uint32_t> first_in_cell_;  ///< the first entry in or behind each
  double first_position_{}, cells_per_meter_{};
};

}  // namespace cambium::inline v0_1
