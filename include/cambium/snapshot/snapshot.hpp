#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include <boost/archive/polymorphic_iarchive.hpp>
#include <boost/archive/polymorphic_oarchive.hpp>

#include "cambium/core/read_file.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/map/map.hpp"
#include "cambium/snapshot/archive_fields.hpp"
#include "cambium/snapshot/archive_world.hpp"
#include "cambium/snapshot/snapshot_error.hpp"

namespace cambium::inline v0_1 {

template <class Domain, class Options>
class MctsWorkspace;

/// The kind of archive in a snapshot, of Boost.Serialization.
enum class SnapshotFormat : std::uint8_t {
  binary,  ///< small and fast; only for platforms with the same sizes and order of bytes
  text,    ///< for exchange between platforms: all bits of every number survive
  xml,     ///< the same, for reading
};

/// How a snapshot is written, and what is noted in it.
struct SnapshotOptions {
  SnapshotFormat format = SnapshotFormat::binary;
  std::string map_file{};                 ///< where the map can be found: path of an OpenDRIVE file
  std::string map_text{};                 ///< the map itself, as OpenDRIVE; empty: not in the snapshot
  std::string component{};                ///< whose state it is: tells the reader which types to restore
  std::string note{};                     ///< why it was taken
  std::optional<std::uint64_t> result{};  ///< `snapshot_hash` of what the next cycle made of these parts
};

/// What the head of a snapshot says. In its texts control characters are escaped (as `\x0a`).
struct SnapshotInfo : SnapshotOptions {
  std::string library{};                    ///< version of cambium
  std::string build{};                      ///< compiler, whether it fuses multiply-adds, and asserts
  std::string platform{};                   ///< sizes and order of bytes
  std::string parts{};                      ///< names, separated by commas
  std::optional<double> time{};             ///< of the first world [s]
  std::optional<std::uint64_t> map_hash{};  ///< of its map, and of what that was built with
};

namespace detail {

using OutArchive = boost::archive::polymorphic_oarchive;
using InArchive = boost::archive::polymorphic_iarchive;

/// The name of a part in snapshots.
template <class T>
[[nodiscard]] constexpr char const* part_name() {
  if constexpr (is_world<T>)
    return "world";
  else if constexpr (requires { typename std::bool_constant<(T::name != nullptr)>; })
    return T::name;
  else
    return "component";
}

/// A part, and how an archive takes it or gives it back.
template <class Archive, class Object>
struct ArchivedPart {
  char const* name;
  Object* object;
  void (*archive)(Archive& archive, char const* name, Object* object);
};
using SavedPart = ArchivedPart<OutArchive, void const>;
using LoadedPart = ArchivedPart<InArchive, void>;

template <class T>
[[nodiscard]] SavedPart saved_part(T const& part) {
  return {part_name<T>(), &part, [](OutArchive& archive, char const* name, void const* object) {
            archive << boost::serialization::make_nvp(name, *static_cast<T const*>(object));
          }};
}
template <class T>
[[nodiscard]] LoadedPart loaded_part(T& part) {
  return {part_name<T>(), &part, [](InArchive& archive, char const* name, void* object) {
            archive >> boost::serialization::make_nvp(name, *static_cast<T*>(object));
          }};
}

/// The map and time of the first world among the parts.
struct SceneOfParts {
  Map const* map = nullptr;
  double time = 0.0;

  template <class T>
  void add(T const& part) {
    if constexpr (is_world<T>)
      if (map == nullptr) {
        map = &part.map();
        time = part.time();
      }
  }
};
template <class... Parts>
[[nodiscard]] SceneOfParts scene_of(Parts const&... parts) {
  SceneOfParts scene;
  (scene.add(parts), ...);
  return scene;
}

/// Parts in an archive, without the head that a snapshot has.
struct ArchivedParts {
  SnapshotFormat format;
  std::string names;
  std::optional<std::uint64_t> map_hash;
  double time = 0.0;
  std::string archive;
};
[[nodiscard]] ArchivedParts archive_parts(SnapshotFormat format, SceneOfParts const& scene,
                                          std::span<SavedPart const> parts);
/// The compiler and flags of this build, as `SnapshotInfo::build` names them.
[[nodiscard]] std::string build_tag();
[[nodiscard]] std::string with_head(ArchivedParts const& parts, SnapshotOptions const& options);
void read_snapshot(std::string_view bytes, std::string const& where, SceneOfParts const& scene,
                   std::span<LoadedPart const> parts);
[[nodiscard]] std::uint64_t hash_of_parts(std::span<SavedPart const> parts);

/// Whether a part is a workspace, of which nothing but kept trees is saved.
template <class T>
inline constexpr bool is_workspace = false;
template <class Domain, class Options>
inline constexpr bool is_workspace<MctsWorkspace<Domain, Options>> = true;

/// Whether a part is read into another object first.
template <class T>
inline constexpr bool is_value_part = is_world<T> || is_workspace<T> || (Described<T> && std::is_copy_assignable_v<T>);

/// What a part is read into: a copy, a new workspace, or the part itself.
template <class T>
struct ReadPart {
  using Into = std::conditional_t<is_value_part<T>, T, T&>;
  T& part;
  Into into = begun(part);

  [[nodiscard]] static Into begun(T& part) {
    if constexpr (is_workspace<T>)
      return T();
    else
      return part;
  }

  void take() {
    if constexpr (is_value_part<T>) part = std::move(into);
  }
};

}  // namespace detail

/// The state of `parts` as bytes: worlds, described structs such as a planner or its memory, the workspace of an `Mcts`
/// with the trees that `keep` has kept (include archive_workspace.hpp), and your own classes that
/// Boost.Serialization can save (with a member `template <class Archive> void serialize(Archive&, unsigned)`, or for
/// `boost::archive::polymorphic_oarchive` and `polymorphic_iarchive` only). What belongs to the environment, such as a
/// logger, such a class leaves out. A world is saved with everything but its map, which is noted by a hash, and its
/// history. Throws `SnapshotError` if a part holds a struct that is not described. O(bytes).
template <class... Parts>
[[nodiscard]] std::string to_snapshot(SnapshotOptions const& options, Parts const&... parts) {
  static_assert(sizeof...(Parts) > 0, "cambium::to_snapshot: name what to save: worlds, planners, memories");
  std::array const saved{detail::saved_part(parts)...};
  return detail::with_head(detail::archive_parts(options.format, detail::scene_of(parts...), saved), options);
}

/// Restores `parts` from a snapshot of parts of the same names and order. A world keeps its map, which must be the one
/// of the snapshot; `snapshot_info` says where that is. A kept tree takes the map of its world, which must come right
/// before the workspace. Your own class keeps what it does not save. Throws `SnapshotError`, before anything is
/// read, if the bytes are no snapshot, damaged, of a newer version, of another platform (binary ones), of other parts
/// or of another map; and if the content does not fit the parts. Then worlds, workspaces and described structs are
/// unchanged; your own class may be half read. `where`: the file, for messages. O(bytes).
template <class... Parts>
void from_snapshot(std::string_view bytes, std::string const& where, Parts&... parts) {
  static_assert(sizeof...(Parts) > 0, "cambium::from_snapshot: name what to restore: worlds, planners, memories");
  std::tuple<detail::ReadPart<Parts>...> read{{parts}...};
  std::apply(
      [&](auto&... each) {
        std::array const loaded{detail::loaded_part<std::remove_reference_t<decltype(each.part)>>(each.into)...};
        detail::read_snapshot(bytes, where, detail::scene_of(parts...), loaded);
        (each.take(), ...);
      },
      read);
}

/// Writes `to_snapshot` to a file, atomically. Throws also `Error` if the file cannot be written.
template <class... Parts>
void save_snapshot(std::filesystem::path const& path, SnapshotOptions const& options, Parts const&... parts) {
  write_file(path, to_snapshot(options, parts...));
}

/// The bytes of a snapshot file. Throws `SnapshotError` if it cannot be read.
[[nodiscard]] inline std::string read_snapshot_file(std::string const& path) {
  return read_file<SnapshotError>(path, {.expected = "give a snapshot file", .smaller = "give a snapshot file"});
}

/// Restores `parts` from a file, see `from_snapshot`.
template <class... Parts>
void load_snapshot(std::string const& path, Parts&... parts) {
  from_snapshot(read_snapshot_file(path), path, parts...);
}

/// What the head of a snapshot says. Throws `SnapshotError` if the bytes are no snapshot, damaged or of a newer
/// version.
[[nodiscard]] SnapshotInfo snapshot_info(std::string_view bytes, std::string const& where = "snapshot");

/// Hash of the state of `parts`: equal if and only if (but for chance) all that a snapshot holds of them is equal, bit
/// for bit. O(bytes).
template <class... Parts>
[[nodiscard]] std::uint64_t snapshot_hash(Parts const&... parts) {
  std::array const saved{detail::saved_part(parts)...};
  return detail::hash_of_parts(saved);
}

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/snapshot/snapshot_impl.hpp"
#endif
