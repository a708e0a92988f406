#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/json.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/text.hpp"
#include "cambium/core/type_info.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/scenario/detail/scenario_maps.hpp"

namespace cambium::inline v0_1::detail {

CAMBIUM_COLD LaneId LaneTable::lane(std::string_view name) const {
  auto const known = numbers_.find(name);
  if (known != numbers_.end()) return known->second;
  auto const number = static_cast<LaneId>(names_.size());
  names_.emplace_back(name);
  return numbers_.emplace(names_.back(), number).first->second;
}

CAMBIUM_COLD LaneId LaneTable::lane_in(Map const& map, LaneId number, std::string const& where) const {
  if (index_of(number) >= names_.size())
    throw ParameterError(where, "names a lane by a number that the file lacks", "it is damaged: take another copy");
  auto const& name = names_[index_of(number)];
  auto const refuse = [&](char const* what, char const* remedy) {
    throw ParameterError(where + ": lane \"" + name + "\"", what, remedy);
  };
  auto parts = split(name, "/");
  bool const backward = parts.size() == 4 && parts[3] == "backward",
             forward = parts.size() == 4 && parts[3] == "forward";
  // A road's name may contain slashes itself, so the numbers are taken from the end.
  std::string_view rest(name);
  std::string_view numbers[2];
  if (backward || forward) rest.remove_suffix(parts[3].size() + 1);
  for (int i = 1; i >= 0; --i) {
    auto const slash = rest.rfind('/');
    if (slash == rest.npos) refuse("is no lane", "write road/section/lane, as \"2/0/-1\"");
    numbers[i] = rest.substr(slash + 1);
    rest = rest.substr(0, slash);
  }
  auto const section = parse_number<std::uint32_t>(numbers[0]);
  auto const lane_number = parse_number<int>(numbers[1]);
  if (!section || !lane_number) refuse("is no lane", "write road/section/lane, as \"2/0/-1\"");
  for (auto const& lane : map.lanes()) {
    if (lane.section != *section || lane.number != *lane_number || map.road(lane.road).name != rest) continue;
    if (is_valid(lane.opposite) && (forward || backward) && lane.along_road != forward) continue;
    return lane.id;
  }
  refuse("is not in its map", "examples/run map FILE lists the lanes");
  return none<LaneId>;
}

CAMBIUM_COLD LaneId LaneTable::number_of(Map const& map, LaneId id) const {
  if (index_of(id) >= map.lanes().size())
    throw ParameterError("lane " + to_string(id), "is not in its map", "take lanes from the scenario's map");
  auto const& lane = map.lane(id);
  std::string const direction = !is_valid(lane.opposite) ? "" : lane.along_road ? "/forward" : "/backward";
  return this->lane(map.road(lane.road).name + "/" + std::to_string(lane.section) + "/" + std::to_string(lane.number) +
                    direction);
}

CAMBIUM_COLD void exchange_lanes(TypeInfo const& type, void* object, Map const& map, LaneTable const& table,
                                 bool to_map, std::string const& where) {
  edit_values(type, object, where, [&](TypeInfo const& plain, void* value) {
    if (plain.kind != TypeInfo::Kind::lane) return;
    auto& lane = *static_cast<LaneId*>(value);
    if (is_valid(lane)) lane = to_map ? table.lane_in(map, lane, where) : table.number_of(map, lane);
  });
}

CAMBIUM_COLD std::shared_ptr<Map const> MapFiles::load(std::filesystem::path const& folder, std::string const& name,
                                                       std::string const& where) {
  if (name.empty()) throw MapError(where, "it names no map", "give \"map_file\", an OpenDRIVE file");
  auto const path = (folder / name).lexically_normal();
  auto& map = maps_[path];
  if (map) return map;
  try {
    map = load_opendrive(path.string()).map;
  } catch (MapError const& problem) {
    throw MapError(where, problem.what());
  }
  return map;
}

}  // namespace cambium::inline v0_1::detail
