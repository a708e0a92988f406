#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "cambium/core/parameters.hpp"
#include "cambium/scenario/dataset/recorded_traffic.hpp"

namespace cambium::inline v0_1 {

/// The point of a body whose place a table gives.
enum class TrackAnchor : std::uint8_t {
  middle,        ///< of the body
  front_middle,  ///< of its front end
  corner,        ///< of its bounding box, the one with the least x and y: of pictures the upper left one
};

/// The columns of a table of tracks and their units; the table has a row for each road user and time. Names are those
/// of the first row; an empty name means that the table has no such column. Needed are `id`, `time`, `x` and `y`.
///
///     without              instead
///     vx, vy, speed        from the places before and behind
///     heading              of the motion; standing, the last one
///     length, width        of a typical body of the type
///     type                 a car
struct TrackTable {
  std::string id = "track_id";
  std::string time = "timestamp_ms";
  std::string x = "x", y = "y";
  std::string vx = "vx", vy = "vy";  ///< along x and y
  std::string speed{};               ///< instead of both
  std::string heading = "psi_rad";   ///< [rad], counter-clockwise from +x
  std::string length = "length";
  std::string width = "width";
  std::string type = "agent_type";  ///< a word such as "car", or NGSIM's number
  double time_unit = 1e-3;
  double length_unit = 1.0;
  bool mirrored = false;
  bool sideways = false;
  TrackAnchor anchor = TrackAnchor::middle;
  double longest_gap = 2.0;

  static constexpr char const* name = "track_table";
  static constexpr auto parameters() {
    using P = TrackTable;
    return parameter_list(
        parameter("time_unit", &P::time_unit, "s", positive, "the unit of the column of times, or of one frame"),
        parameter("length_unit", &P::length_unit, "m", positive, "the unit of places and sizes; of speeds, per second"),
        parameter("mirrored", &P::mirrored, "y grows to the right of x, as in pictures"),
        parameter("sideways", &P::sideways, "y is along the road and x to the right of it"),
        choice("anchor", &P::anchor, "middle|front_middle|corner", "which point of the body is given"),
        parameter("longest_gap", &P::longest_gap, "s", positive,
                  "an id that comes again after a longer time is another road user, with a new id"));
  }
};

/// INTERACTION's files of vehicles, and of pedestrians and cyclists (which have neither size nor heading).
[[nodiscard]] TrackTable interaction_tracks();

/// highD's files `XX_tracks.csv`, and those of its kin with upper left corners; `frame_rate` [1/s] is in the file
/// `XX_recordingMeta.csv`. The picture's y becomes -y. Types are in another file: all are cars, or trucks where they
/// are longer than 7 m.
[[nodiscard]] TrackTable highd_tracks(double frame_rate = 25.0);

/// NGSIM's trajectory tables, in feet, along the road: its Local_Y becomes x, and -Local_X becomes y. Headings are
/// those of the motion.
[[nodiscard]] TrackTable ngsim_tracks();

/// The tracks of a table of comma- or semicolon-separated values, in the order of their first rows; `name` names it in
/// messages. Rows may come in any order. `RecordedTraffic::time_step` is the least difference of two times of a track.
/// Throws `Error` with the line where a column or cell is missing or no number, and where a track has two rows for one
/// time; with the track where its size is impossible. Sizes that change within a track, velocities that contradict the
/// motion, gaps in time and ids that come again are diagnostics. O(n log n).
[[nodiscard]] RecordedTraffic read_tracks(std::string_view text, TrackTable const& table = interaction_tracks(),
                                          std::string const& name = "text");

/// As `read_tracks`, from a file. Throws `Error` where it cannot be read, too.
[[nodiscard]] RecordedTraffic load_tracks(std::string const& path, TrackTable const& table = interaction_tracks());

/// The tracks as a table of the kind that `interaction_tracks` reads. Places, headings and sizes read back as the same
/// bits; speeds but for rounding; times become whole milliseconds. Linear in the states.
[[nodiscard]] std::string interaction_text(RecordedTraffic const& traffic);

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/dataset/track_table_impl.hpp"
#endif
