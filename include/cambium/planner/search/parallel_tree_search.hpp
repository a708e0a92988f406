#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <future>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/planner/search/search_result.hpp"
#include "cambium/planner/search/tree_search_parameters.hpp"

namespace cambium::inline v0_1 {

/// Several independent trees, one per thread, merged at the root: visits and returns of the same action are added (root
/// parallelisation: Chaslot, Winands, van den Herik 2008). The trees share the budget and the memory. Under an
/// iteration budget, the result is a pure function of state, parameters, seed and number of trees. Each run starts new
/// threads. A single tree needs none and equals the plain search.
template <class Search>
class ParallelTreeSearch {
 public:
  using State = typename Search::State;
  using Action = typename Search::Action;
  using Result = typename Search::Result;
  using Domain = std::remove_cvref_t<decltype(std::declval<Search&>().domain())>;

  /// Without trees; call `set` before `run`.
  ParallelTreeSearch() = default;

  /// Copies domain and parameters of `search`. Throws as `set`.
  ParallelTreeSearch(Search const& search, std::size_t trees) {
    set(search.domain(), search.parameters(), search.selection(), search.rollout(), search.budget(), trees);
  }

  /// Replaces domain and parameters, and uses `trees` trees, but at most one per iteration. Keeps memory and kept trees
  /// as `TreeSearch::set`. Throws `ParameterError` if `trees` is not from 1 to 1024 or a parameter is out of range.
  template <class Selection, class Rollout, class Budget>
  void set(Domain const& domain, TreeSearchParameters parameters, Selection const& selection, Rollout const& rollout,
           Budget const& budget, std::size_t trees) {
    if (trees == 0 || trees > 1024)
      throw ParameterError("ParallelTreeSearch", "has " + std::to_string(trees) + " trees",
                           "give 1 to 1024, at most one per core");
    auto const count = std::min(trees, std::max<std::size_t>(1, budget.most()));
    if (count > 1) parameters.memory = std::max<std::size_t>(4096, parameters.memory / count);
    searches_.reserve(count);
    while (searches_.size() > count) searches_.pop_back();
    for (std::size_t i = 0; i < count; ++i) {
      if (i == searches_.size())
        searches_.emplace_back(domain);
      else
        searches_[i].domain() = domain;
      searches_[i].set(parameters, selection, rollout, budget.part(i, count));
    }
  }

  /// As `TreeSearch::keep` and `forget`, for each tree. `keep` returns whether any tree kept something.
  bool keep(std::span<Action const> joint) {
    bool any = false;
    for (auto& search : searches_) any = search.keep(joint) || any;
    return any;
  }
  void forget() {
    for (auto& search : searches_) search.forget();
  }

  /// As `TreeSearch::run`. The principal variation comes from the tree that agrees with the best actions and visited
  /// them most. Rethrows what a domain throws.
  Result const& run(State const& root, std::uint64_t seed) {
    if (searches_.empty()) throw SearchError("ParallelTreeSearch", "has no domain yet", "call `set` before `run`");
    if (searches_.size() == 1) return searches_[0].run(root, seed);
    auto const grow = [&](std::size_t i) { searches_[i].run(root, seed, static_cast<std::uint32_t>(i)); };
    std::vector<std::future<void>> crew;  // wait when they are destroyed
    for (std::size_t i = 1; i < searches_.size(); ++i) crew.push_back(std::async(std::launch::async, grow, i));
    grow(0);
    for (auto& other : crew) other.get();
    merge();
    return result_;
  }

  [[nodiscard]] Result const& result() const { return searches_.size() == 1 ? searches_[0].result() : result_; }
  [[nodiscard]] std::vector<Search>& searches() { return searches_; }
  [[nodiscard]] std::vector<Search> const& searches() const { return searches_; }

 private:
  void merge() {
    for (auto const& search : searches_)
      if (search.result().problem != SearchProblem::none) {  // a problem makes the result empty
        result_ = search.result();
        return;
      }
    result_ = searches_[0].result();
    std::vector<ReturnScale> scales(searches_[0].scales().begin(), searches_[0].scales().end());
    for (std::size_t i = 1; i < searches_.size(); ++i) {
      auto const& other = searches_[i].result();
      result_.iterations += other.iterations;
      result_.nodes += other.nodes;
      result_.kept_nodes += other.kept_nodes;
      result_.is_full = result_.is_full || other.is_full;
      for (std::size_t d = 0; d < result_.depths.size(); ++d) result_.depths[d] += other.depths[d];
      for (std::size_t k = 0; k < scales.size(); ++k) scales[k].include(searches_[i].scales()[k]);
      add_arms(other);
    }
    auto const& parameters = searches_[0].parameters();
    for (std::size_t k = 0; k < result_.agents; ++k)
      result_.best[k] =
          detail::final_choice(result_.of(k), scales[k], parameters.final_move, parameters.constraint.limit);
    take_variation();
  }

  /// Adds the arms of another tree to those with the same action, and appends the rest.
  void add_arms(Result const& other) {
    std::vector<RootArm<Action>> arms;
    std::vector<std::size_t> first;
    for (std::size_t k = 0; k < result_.agents; ++k) {
      first.push_back(arms.size());
      auto const own = result_.of(k);
      arms.insert(arms.end(), own.begin(), own.end());
      for (auto const& arm : other.of(k)) {
        auto const begin = arms.begin() + static_cast<std::ptrdiff_t>(first[k]);
        auto const same = std::find_if(begin, arms.end(), [&](auto const& a) { return a.action == arm.action; });
        if (same == arms.end())
          arms.push_back(arm);
        else
          add(*same, arm);
      }
      std::span const all(arms.begin() + static_cast<std::ptrdiff_t>(first[k]), arms.end());
      double const visits = detail::total_visits(all);
      for (auto& arm : all) arm.share = visits > 0.0 ? arm.visits / visits : 0.0;
    }
    first.push_back(arms.size());
    result_.arms = std::move(arms);
    result_.first_arm = std::move(first);
  }

  static void add(RootArm<Action>& arm, RootArm<Action> const& other) {
    auto const visits = arm.visits + other.visits;
    if (visits == 0) return;
    arm.mean_return = (arm.mean_return * arm.visits + other.mean_return * other.visits) / visits;
    arm.mean_cost = (arm.mean_cost * arm.visits + other.mean_cost * other.visits) / visits;
    arm.visits = visits;
  }

  void take_variation() {
    std::uint32_t most = 0;
    result_.variation.clear();
    for (auto const& search : searches_) {
      auto const& own = search.result();
      bool agrees = true;
      for (std::size_t k = 0; k < result_.agents; ++k)
        agrees = agrees && own.choice(k).action == result_.choice(k).action;
      if (!agrees || own.choice(0).visits <= most) continue;
      most = own.choice(0).visits;
      result_.variation = own.variation;
    }
    if (most == 0)  // no tree agrees with the merged choice
      for (std::size_t k = 0; k < result_.agents; ++k) result_.variation.push_back(result_.choice(k).action);
  }

  std::vector<Search> searches_;
  Result result_;
};

}  // namespace cambium::inline v0_1
