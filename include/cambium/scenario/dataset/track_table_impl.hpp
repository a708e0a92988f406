#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/read_file.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/core/text.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/scenario/dataset/track_table.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// The type that a table's word or number stands for.
[[nodiscard]] inline TrackType track_type_of(std::string_view word) {
  constexpr std::pair<std::string_view, TrackType> words[] = {{"car", TrackType::car},
                                                              {"van", TrackType::car},
                                                              {"taxi", TrackType::car},
                                                              {"truck", TrackType::truck},
                                                              {"trailer", TrackType::truck},
                                                              {"truck_bus", TrackType::truck},
                                                              {"bus", TrackType::bus},
                                                              {"motorcycle", TrackType::motorcycle},
                                                              {"bicycle", TrackType::bicycle},
                                                              {"cyclist", TrackType::bicycle},
                                                              {"pedestrian", TrackType::pedestrian},
                                                              {"pedestrian/bicycle", TrackType::pedestrian},
                                                              {"1", TrackType::motorcycle},
                                                              {"2", TrackType::car},
                                                              {"3", TrackType::truck}};
  for (auto const& [name, type] : words)
    if (std::equal(word.begin(), word.end(), name.begin(), name.end(),
                   [](char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; }))
      return type;
  return TrackType::other;
}

/// The size of a typical body of the type [m].
[[nodiscard]] inline std::pair<double, double> typical_size(TrackType type) {
  constexpr geometry::Shape shapes[] = {geometry::car(),        geometry::truck(),   geometry::bus(),
                                        geometry::motorcycle(), geometry::bicycle(), geometry::pedestrian(),
                                        geometry::car()};
  auto const& shape = shapes[static_cast<std::size_t>(type)];
  return {shape.length(), shape.width()};
}

/// Reads a table of tracks, see `read_tracks`.
class TrackTableReader {
 public:
  TrackTableReader(std::string_view text, TrackTable const& table, std::string const& name)
      : text_(text), table_(table), name_(name) {
    traffic_.name = name;
  }

  [[nodiscard]] RecordedTraffic read() {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
    while (!text_.empty()) {
      auto const end = std::min(text_.find('\n'), text_.size());
      auto const row = trimmed(text_.substr(0, end));
      text_.remove_prefix(std::min(end + 1, text_.size()));
      ++line_;
      if (row.empty() || row.front() == '#') continue;
      columns_ == 0 ? read_heading(row) : read_row(row);
    }
    if (columns_ == 0) throw Error(name_, "it has no row", "give a table whose first row names the columns");
    part_at_gaps();
    double step = std::numeric_limits<double>::infinity();
    for (auto& read : read_) step = std::min(step, finish(read));
    if (std::isfinite(step)) traffic_.time_step = step;
    for (auto& read : read_) report_gaps(read);
    check_recorded_traffic(traffic_);
    return std::move(traffic_);
  }

 private:
  enum Column { id, time, x, y, vx, vy, speed, heading, length, width, type, columns };
  struct Row {
    int line = 0;
    State state{};
    double vx = 0.0, vy = 0.0, length = 0.0, width = 0.0;
    TrackType type = TrackType::car;
  };
  struct Read {
    Track track;
    std::vector<Row> rows;
  };

  [[noreturn]] void fail(std::string const& what, std::string const& remedy) const { fail(line_, what, remedy); }
  [[noreturn]] void fail(int line, std::string const& what, std::string const& remedy) const {
    throw Error(name_ + ":" + std::to_string(line), what, remedy);
  }
  void report(Severity severity, int line, Track const& track, std::string sentence) {
    traffic_.diagnostics.push_back(
        {severity, name_, line, "", "track " + std::to_string(track.id), std::move(sentence)});
  }

  [[nodiscard]] std::vector<std::string_view> cells_of(std::string_view row) const {
    auto cells = split(row, separator_);
    for (auto& cell : cells) cell = trimmed(cell, " \t\"");
    return cells;
  }

  void read_heading(std::string_view row) {
    if (row.find(';') != row.npos) separator_ = ";";
    auto const cells = cells_of(row);
    columns_ = cells.size();
    std::string const* const names[] = {&table_.id,     &table_.time,  &table_.x,     &table_.y,
                                        &table_.vx,     &table_.vy,    &table_.speed, &table_.heading,
                                        &table_.length, &table_.width, &table_.type};
    for (std::size_t column = 0; column < columns; ++column) {
      auto const at = names[column]->empty() ? cells.end() : std::find(cells.begin(), cells.end(), *names[column]);
      if (at != cells.end())
        place_[column] = static_cast<std::size_t>(at - cells.begin());
      else if (column <= y)
        fail("there is no column \"" + *names[column] + "\"",
             "name the table's columns in TrackTable, or choose interaction_tracks, highd_tracks or ngsim_tracks");
    }
  }

  [[nodiscard]] std::string_view cell(std::vector<std::string_view> const& cells, Column column) const {
    if (*place_[column] >= cells.size())
      fail("it has " + std::to_string(cells.size()) + " cells, the first row " + std::to_string(columns_),
           "give each row the same columns");
    return cells[*place_[column]];
  }

  /// The number in a column; nothing where the table has no such column.
  [[nodiscard]] std::optional<double> number(std::vector<std::string_view> const& cells, Column column) const {
    if (!place_[column]) return std::nullopt;
    auto const word = cell(cells, column);
    auto const value = parse_number<double>(word);
    if (!value || std::abs(*value) > 1e15)
      fail("\"" + std::string(word) + "\" is no number that can be a place, a time or a size",
           "write numbers like 12.5, and leave rows without them out");
    return value;
  }

  /// The id: a whole number, or one behind a letter, as INTERACTION's "P3" of pedestrians.
  [[nodiscard]] std::int64_t id_of(std::string_view word) const {
    auto digits = word;
    while (!digits.empty() && (digits.front() < '0' || digits.front() > '9') && digits.front() != '-')
      digits.remove_prefix(1);
    auto const value = parse_number<std::int64_t>(digits);
    if (!value) fail("\"" + std::string(word) + "\" is no id", "give each road user a whole number");
    return *value;
  }

  /// A vector of the table as one of the map frame.
  [[nodiscard]] geometry::Point turned(double a, double b) const {
    if (table_.sideways) return {b, -a};
    return {a, table_.mirrored ? -b : b};
  }

  void read_row(std::string_view text) {
    auto const cells = cells_of(text);
    if (cells.size() > columns_)
      fail("it has " + std::to_string(cells.size()) + " cells, the first row " + std::to_string(columns_),
           "give each row the same columns, and numbers a decimal point");
    auto const key = id_of(cell(cells, id));
    auto const [at, is_new] = places_.try_emplace(key, read_.size());
    if (is_new) {
      read_.emplace_back();
      read_.back().track.id = key;
    }
    double const unit = table_.length_unit;
    Row row{line_};
    if (place_[type]) row.type = track_type_of(cell(cells, type));
    auto const typical = typical_size(row.type);
    auto const long_ = number(cells, length), wide = number(cells, width);
    row.length = long_ ? *long_ * unit : typical.first;
    row.width = wide ? *wide * unit : typical.second;
    row.state.time = *number(cells, time) * table_.time_unit;
    auto const place = turned(*number(cells, x) * unit, *number(cells, y) * unit);
    row.state.x = place.x();
    row.state.y = place.y();
    if (auto const angle = number(cells, heading))
      row.state.heading = table_.sideways ? *angle - 0.5 * geometry::pi : table_.mirrored ? -*angle : *angle;
    if (has_velocity()) {
      auto const velocity = turned(*number(cells, vx) * unit, *number(cells, vy) * unit);
      row.vx = velocity.x();
      row.vy = velocity.y();
      row.state.speed = portable::hypot(row.vx, row.vy);
    }
    if (auto const fast = number(cells, speed)) row.state.speed = *fast * unit;
    read_[at->second].rows.push_back(row);
  }

  [[nodiscard]] bool has_velocity() const { return place_[vx] && place_[vy]; }
  [[nodiscard]] bool has_speed() const { return has_velocity() || place_[speed]; }

  /// Sorts the rows by time; whoever is not recorded for long and comes again is somebody else.
  void part_at_gaps() {
    std::int64_t unused = 0;  // above all ids, where these leave room for it
    constexpr auto highest = std::numeric_limits<std::int64_t>::max() / 2;
    for (auto const& read : read_)
      if (read.track.id < highest) unused = std::max(unused, read.track.id + 1);
    for (std::size_t i = 0, count = read_.size(); i < count; ++i) {
      stable_sort(read_[i].rows, [](Row const& row) { return row.state.time; });
      auto rows = std::move(read_[i].rows);
      std::size_t begin = 0, gaps = 0;
      for (std::size_t k = 1; k <= rows.size(); ++k) {
        double const gap =
            k < rows.size() ? rows[k].state.time - rows[k - 1].state.time : std::numeric_limits<double>::infinity();
        if (!(gap > table_.longest_gap)) continue;
        std::vector<Row> part(rows.begin() + static_cast<std::ptrdiff_t>(begin),
                              rows.begin() + static_cast<std::ptrdiff_t>(k));
        if (begin == 0) {
          read_[i].rows = std::move(part);
        } else {
          read_.push_back({read_[i].track, std::move(part)});
          read_.back().track.id = unused++;
        }
        begin = k;
        if (k == rows.size()) break;
        if (gaps++ == 0)
          report(Severity::warning, rows[k].line, read_[i].track,
                 "nothing is recorded for " + rounded_text(gap) +
                     " s before this row; from here on it is another one, track " + std::to_string(unused));
      }
      if (gaps > 1)
        report(Severity::warning, 0, read_[i].track,
               "it has " + std::to_string(gaps) + " gaps of more than " + rounded_text(table_.longest_gap) +
                   " s, each the end of a track: is the unit of time right?");
    }
  }

  /// Fills the track from its rows, which are sorted; the least difference of their times [s].
  double finish(Read& read) {
    auto& rows = read.rows;
    double step = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < rows.size(); ++i) {
      double const passed = rows[i].state.time - rows[i - 1].state.time;
      if (!(passed > 1e-9))
        fail(rows[i].line,
             "track " + std::to_string(read.track.id) + " has a row for " + rounded_text(rows[i].state.time) +
                 " s already, in line " + std::to_string(rows[i - 1].line),
             "leave one of them out, or give the road users ids of their own");
      step = std::min(step, passed);
    }
    take_body(read);
    if (!place_[type] && place_[length] && read.track.length > 7.0) read.track.type = TrackType::truck;
    move_to_middle(read);
    if (!place_[heading]) set_headings(rows);
    move_front_to_middle(read);
    set_speeds(read);
    for (auto const& row : rows) read.track.states.push_back(row.state);
    traffic_.tracks.push_back(read.track);
    return step;
  }

  /// The size and type of its first row.
  void take_body(Read& read) {
    auto const& first = read.rows.front();
    read.track.length = first.length;
    read.track.width = first.width;
    read.track.type = first.type;
    bool size_changes = false, type_changes = false;
    for (auto const& row : read.rows) {
      size_changes = size_changes || std::abs(row.length - first.length) + std::abs(row.width - first.width) > 0.1;
      type_changes = type_changes || row.type != first.type;
    }
    if (size_changes) report(Severity::info, 0, read.track, "its size changes; that of its first row counts");
    if (type_changes) report(Severity::info, 0, read.track, "its type changes; that of its first row counts");
  }

  /// From the corner of a bounding box to the middle; its sides are those of the table.
  void move_to_middle(Read& read) const {
    if (table_.anchor != TrackAnchor::corner) return;
    auto const to_middle = turned(0.5 * read.track.length, 0.5 * read.track.width);
    for (auto& row : read.rows) {
      row.state.x += to_middle.x();
      row.state.y += to_middle.y();
    }
  }
  void move_front_to_middle(Read& read) const {
    if (table_.anchor != TrackAnchor::front_middle) return;
    for (auto& row : read.rows) {
      row.state.x -= 0.5 * read.track.length * portable::cos(row.state.heading);
      row.state.y -= 0.5 * read.track.length * portable::sin(row.state.heading);
    }
  }

  /// Headings of the motion: by the velocity, else over half a metre or more; a standing body keeps its last one.
  void set_headings(std::vector<Row>& rows) const {
    constexpr double slow = 0.5, shortest = 0.5;  // [m/s], [m]
    std::vector<bool> known(rows.size());
    std::size_t before = 0, behind = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      double dx = rows[i].vx, dy = rows[i].vy;
      if (!has_velocity()) {
        auto const apart = [&](std::size_t a, std::size_t b) {
          return portable::hypot(rows[b].state.x - rows[a].state.x, rows[b].state.y - rows[a].state.y);
        };
        while (before + 1 < i && apart(before + 1, i) >= 0.5 * shortest) ++before;
        behind = std::max(behind, i);
        while (behind + 1 < rows.size() && apart(i, behind) < 0.5 * shortest) ++behind;
        if (apart(before, behind) < shortest) continue;
        dx = rows[behind].state.x - rows[before].state.x;
        dy = rows[behind].state.y - rows[before].state.y;
      } else if (portable::hypot(dx, dy) < slow) {
        continue;
      }
      rows[i].state.heading = portable::atan2(dy, dx);
      known[i] = true;
    }
    auto const first = std::find(known.begin(), known.end(), true) - known.begin();
    if (first == static_cast<std::ptrdiff_t>(rows.size())) return;
    double last = rows[static_cast<std::size_t>(first)].state.heading;
    for (std::size_t i = 0; i < rows.size(); ++i)
      last = known[i] ? rows[i].state.heading : (rows[i].state.heading = last);
  }

  /// Speeds from places where the table has none; backwards where the motion is against the heading.
  void set_speeds(Read& read) {
    auto& rows = read.rows;
    int contradictions = 0, first = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      auto const &a = rows[i > 0 ? i - 1 : i].state, &b = rows[i + 1 < rows.size() ? i + 1 : i].state;
      auto& state = rows[i].state;
      double const passed = b.time - a.time;
      if (!(passed > 0.0)) continue;
      double const dx = b.x - a.x, dy = b.y - a.y,
                   along = (dx * portable::cos(state.heading) + dy * portable::sin(state.heading)) / passed,
                   fast = portable::hypot(dx, dy) / passed;
      if (!has_speed()) state.speed = fast;
      if (along < -0.5 * fast && fast > 0.3) state.speed = -std::abs(state.speed);
      if (std::abs(std::abs(state.speed) - fast) > 3.0 + 0.3 * fast && ++contradictions == 1) first = rows[i].line;
    }
    if (contradictions > 0)
      report(
          Severity::warning, first, read.track,
          "its speed contradicts its motion in " + std::to_string(contradictions) + " rows; it was taken as written");
  }

  void report_gaps(Read const& read) {
    for (std::size_t i = 1; i < read.rows.size(); ++i) {
      double const passed = read.rows[i].state.time - read.rows[i - 1].state.time;
      if (passed <= 1.5 * traffic_.time_step) continue;
      return report(
          Severity::info, read.rows[i].line, read.track,
          "nothing is recorded for " + rounded_text(passed) + " s before this row; between them it moves evenly");
    }
  }

  std::string_view text_;
  TrackTable const& table_;
  std::string const& name_;
  std::string_view separator_ = ",";
  int line_ = 0;
  std::size_t columns_ = 0;
  std::array<std::optional<std::size_t>, columns> place_{};
  std::vector<Read> read_;
  std::map<std::int64_t, std::size_t> places_;
  RecordedTraffic traffic_;
};

}  // namespace detail

CAMBIUM_COLD TrackTable interaction_tracks() { return {}; }

CAMBIUM_COLD TrackTable highd_tracks(double frame_rate) {
  TrackTable table;
  table.id = "id";
  table.time = "frame";
  table.time_unit = 1.0 / frame_rate;
  table.vx = "xVelocity";
  table.vy = "yVelocity";
  table.heading = {};
  table.length = "width";  // of the picture's box: along the road
  table.width = "height";
  table.type = {};
  table.mirrored = true;
  table.anchor = TrackAnchor::corner;
  return table;
}

CAMBIUM_COLD TrackTable ngsim_tracks() {
  TrackTable table;
  table.id = "Vehicle_ID";
  table.time = "Frame_ID";
  table.time_unit = 0.1;
  table.x = "Local_X";
  table.y = "Local_Y";
  table.vx = table.vy = table.heading = {};
  table.speed = "v_Vel";
  table.length = "v_Length";
  table.width = "v_Width";
  table.type = "v_Class";
  table.length_unit = 0.3048;
  table.sideways = true;
  table.anchor = TrackAnchor::front_middle;
  return table;
}

CAMBIUM_COLD RecordedTraffic read_tracks(std::string_view text, TrackTable const& table, std::string const& name) {
  check_parameters(table, name);
  return detail::TrackTableReader(text, table, name).read();
}

CAMBIUM_COLD RecordedTraffic load_tracks(std::string const& path, TrackTable const& table) {
  FileKind const kind{.expected = "give a table of tracks (.csv)", .smaller = "split the table"};
  return read_tracks(read_file<Error>(path, kind), table, path);
}

CAMBIUM_COLD std::string interaction_text(RecordedTraffic const& traffic) {
  using detail::number_text;
  std::string text = "track_id,frame_id,timestamp_ms,agent_type,x,y,vx,vy,psi_rad,length,width\n";
  for (auto const& track : traffic.tracks)
    for (auto const& state : track.states) {
      auto const milliseconds = std::llround(1000.0 * state.time);
      auto const frame = std::llround(state.time / traffic.time_step);
      text += std::to_string(track.id) + "," + std::to_string(frame) + "," + std::to_string(milliseconds) + "," +
              to_string(track.type);
      for (double const value : {state.x, state.y, state.speed * portable::cos(state.heading),
                                 state.speed * portable::sin(state.heading), state.heading, track.length, track.width})
        text += "," + number_text(value);
      text += "\n";
    }
  return text;
}

}  // namespace cambium::inline v0_1
