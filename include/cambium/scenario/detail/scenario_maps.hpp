#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/json.hpp"
#include "cambium/core/type_info.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::detail {

/// Lanes of several maps by name: in the files' structs, `LaneId` k stands for the k-th name.
class LaneTable final : public LaneNames {
 public:
  LaneTable() = default;
  explicit LaneTable(std::vector<std::string> const& names) {
    for (auto const& name : names) static_cast<void>(lane(name));
  }

  [[nodiscard]] std::vector<std::string> const& names() const { return names_; }
  [[nodiscard]] std::string name(LaneId lane) const override { return names_[index_of(lane)]; }
  [[nodiscard]] LaneId lane(std::string_view name) const override;

  /// The lane of `map` that a number stands for. Throws `ParameterError` at `where` if the map has no such lane.
  [[nodiscard]] LaneId lane_in(Map const& map, LaneId number, std::string const& where) const;
  /// The number that stands for a lane of `map`.
  [[nodiscard]] LaneId number_of(Map const& map, LaneId id) const;

 private:
  mutable std::vector<std::string> names_;
  mutable std::map<std::string, LaneId, std::less<>> numbers_;
};

/// Map files that were loaded, by path. Throws `MapError` if one cannot be read.
class MapFiles {
 public:
  /// `name`: as in the file; `folder`: that of the scenario file.
  [[nodiscard]] std::shared_ptr<Map const> load(std::filesystem::path const& folder, std::string const& name,
                                                std::string const& where);

 private:
  std::map<std::filesystem::path, std::shared_ptr<Map const>> maps_;
};

/// Replaces the lanes of a struct: those of `map` by numbers of `table`, or the other way.
void exchange_lanes(TypeInfo const& type, void* object, Map const& map, LaneTable const& table, bool to_map,
                    std::string const& where);

}  // namespace cambium::inline v0_1::detail

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/detail/scenario_maps_impl.hpp"
#endif
