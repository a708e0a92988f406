#pragma once

#include <algorithm>
#include <tuple>
#include <vector>

#include "cambium/benchmark/result_group.hpp"
#include "cambium/benchmark/result_store.hpp"
#include "cambium/core/text.hpp"

namespace cambium::inline v0_1 {

/// All results of a database in groups: by set, behaviour, parameters and version. Throws `StoreError` if it cannot be
/// read. O(rows + groups²).
[[nodiscard]] inline std::vector<ResultGroup> read_results(ResultStore& store) {
  std::vector<ResultGroup> groups;
  store.for_each([&](ResultRow const& row) {
    auto const& key = row.key;
    auto const belongs = [&key](ResultGroup const& group) {
      return group.set_hash == key.set_hash && group.behavior == key.behavior &&
             group.parameters_hash == key.parameters_hash && group.version == key.version;
    };
    if (groups.empty() || !belongs(groups.back()))
      groups.push_back({.set_hash = key.set_hash,
                        .behavior = key.behavior,
                        .parameters_hash = key.parameters_hash,
                        .version = key.version,
                        .label = key.behavior});
    groups.back().rows.push_back({key.scenario, row.seed, row.result, row.times, row.population});
  });
  for (auto& group : groups) {
    group.set = store.title_of(group.set_hash);
    group.source = store.source_of(group.set_hash);
    group.parameters = store.parameters_of(group.behavior, group.parameters_hash);
    group.command = store.command_of(group.behavior, group.parameters_hash);
  }
  for (auto& group : groups) {
    bool other_set = false, other_parameters = false, other_version = false;
    for (auto const& other : groups) {
      other_set |= other.set == group.set && other.set_hash != group.set_hash;
      bool const rivals = other.behavior == group.behavior;
      other_parameters |= rivals && other.parameters_hash != group.parameters_hash;
      other_version |= rivals && other.version != group.version;
    }
    group.set_label = group.set + (other_set ? " #" + hash_text(group.set_hash).substr(0, 8) : "");
    if (other_parameters) group.label += " #" + hash_text(group.parameters_hash).substr(0, 8);
    if (other_version) group.label += " " + group.version;
  }
  std::sort(groups.begin(), groups.end(), [](auto const& a, auto const& b) {
    auto const key = [](auto const& g) {
      return std::tie(g.set_label, g.set_hash, g.behavior, g.parameters_hash, g.version);
    };
    return key(a) < key(b);
  });
  return groups;
}

}  // namespace cambium::inline v0_1
