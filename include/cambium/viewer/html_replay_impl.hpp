#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/core/markup.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/viewer/detail/lane_marks.hpp"
#include "cambium/viewer/detail/page_script.hpp"
#include "cambium/viewer/detail/replay_controls.hpp"
#include "cambium/viewer/detail/replay_page.hpp"
#include "cambium/viewer/detail/replay_script.hpp"
#include "cambium/viewer/html_replay.hpp"
#include "cambium/viewer/recording.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// Writes a recording as the JSON object that the replay page reads. Positions are relative to `origin`, a point near
/// the map rounded to whole kilometres: maps in national coordinates get short numbers, and small maps near (0, 0) keep
/// theirs.
class ReplayData {
 public:
  explicit ReplayData(Recording const& recording) : recording_(recording) {
    for (RecordedLane const& lane : recording.lanes) areas_.emplace_back(lane);
    origin_ = middle_of_all();
    for (double* value : {&origin_.x(), &origin_.y()}) *value = 1000.0 * std::round(*value / 1000.0);
  }

  [[nodiscard]] std::string json() {
    out_ = "{\"origin\":";
    list({origin_.x(), origin_.y()}, 0);
    out_ += ",\n\"lanes\":";
    lanes();
    out_ += ",\n\"marks\":";
    each(LaneMarker(recording_.lanes, areas_).marks(), [this](LaneMark const& mark) {
      out_ += '[' + std::to_string(static_cast<std::uint32_t>(mark.style)) + ',';
      points(mark.points);
      out_ += ']';
    });
    out_ += ",\n\"arrows\":";
    each(lane_arrows(recording_.lanes, areas_, 50.0), [this](LaneArrow const& arrow) {
      list({arrow.at.x() - origin_.x(), arrow.at.y() - origin_.y(), arrow.heading}, 2);
    });
    out_ += ",\n\"stops\":";
    each(recording_.stop_lines, [this](RecordedStopLine const& line) { stop(line); });
    agents();
    out_ += ",\n\"times\":";
    each(recording_.frames, [this](RecordedFrame const& frame) { append_number(out_, frame.time, 3); });
    out_ += ",\n\"frames\":";
    each(recording_.frames, [this](RecordedFrame const& frame) { poses(frame); });
    out_ += ",\n\"lights\":";
    lights();
    return out_ + "}";
  }

 private:
  template <class Range, class Write>
  void each(Range const& range, Write const& write, char const* separator = ",\n") {
    out_ += '[';
    bool first = true;
    for (auto const& item : range) {
      if (!first) out_ += separator;
      first = false;
      write(item);
    }
    out_ += ']';
  }

  void list(std::initializer_list<double> values, int decimals) {
    each(
        values, [this, decimals](double value) { append_number(out_, value, decimals); }, ",");
  }

  void points(PointList const& line) {
    each(
        line,
        [this](geometry::Point const& p) {
          append_number(out_, p.x() - origin_.x(), 2);
          out_ += ',';
          append_number(out_, p.y() - origin_.y(), 2);
        },
        ",");
  }

  void lanes() {
    std::size_t index = 0;
    each(areas_, [this, &index](LaneArea const& area) {
      RecordedLane const& lane = recording_.lanes[index++];
      out_ += '[' + std::to_string(static_cast<std::uint32_t>(lane.kind)) + ',' + json_string(lane.label) + ',';
      points(area.outline);
      out_ += ']';
    });
  }

  void stop(RecordedStopLine const& line) {
    out_ += '[';
    points({line.left, line.right});
    out_ += ',' + (is_valid(line.light) ? to_string(line.light) : "-1") + ']';
  }

  // One digit per light, and only for frames in which a light has changed: [frame, "0123"].
  void lights() {
    std::vector<std::pair<std::size_t, std::string>> changes;
    for (std::size_t k = 0; k < recording_.frames.size(); ++k) {
      std::string digits;
      for (auto const color : recording_.frames[k].lights) digits += static_cast<char>('0' + static_cast<int>(color));
      if (changes.empty() || changes.back().second != digits) changes.emplace_back(k, digits);
    }
    each(changes,
         [this](auto const& change) { out_ += '[' + std::to_string(change.first) + ",\"" + change.second + "\"]"; });
  }

  void agents() {
    out_ += ",\n\"agents\":";
    each(recording_.agents, [this](RecordedAgent const& agent) {
      out_ += "[\"" + to_string(agent.id) + "\"," + std::to_string(static_cast<std::uint32_t>(agent.kind)) + ',' +
              json_string(agent.label);
      for (double side : {agent.shape.front, agent.shape.rear, agent.shape.left, agent.shape.right}) {
        out_ += ',';
        append_number(out_, std::isfinite(side) ? side : 0.0, 3);
      }
      out_ += ']';
    });
  }

  // An agent that is absent, or whose pose is not finite, is written as 0: there is nothing to draw.
  void poses(RecordedFrame const& frame) {
    each(
        frame.poses,
        [this](RecordedPose const& pose) {
          if (!pose.present || !std::isfinite(pose.x + pose.y + pose.heading)) {
            out_ += '0';
            return;
          }
          out_ += '[';
          append_number(out_, pose.x - origin_.x(), 2);
          out_ += ',';
          append_number(out_, pose.y - origin_.y(), 2);
          out_ += ',';
          append_number(out_, pose.heading, 3);
          for (double value : {pose.speed, pose.acceleration}) {
            out_ += ',';
            append_number(out_, std::isfinite(value) ? value : 0.0, 2);
          }
          out_ += ']';
        },
        ",");
  }

  [[nodiscard]] geometry::Point middle_of_all() const {
    for (LaneArea const& area : areas_)
      if (!area.empty()) return 0.5 * (area.low + area.high);
    for (RecordedFrame const& frame : recording_.frames)
      for (RecordedPose const& pose : frame.poses)
        if (pose.present && std::isfinite(pose.x + pose.y)) return {pose.x, pose.y};
    return {0.0, 0.0};
  }

  Recording const& recording_;
  std::vector<LaneArea> areas_;
  geometry::Point origin_{0.0, 0.0};
  std::string out_;
};

/// The page's header: title, numbers of agents and frames, duration, and notes.
inline std::string replay_header(Recording const& recording) {
  std::size_t const frames = recording.frames.size();
  std::string text = "<header><div class=\"head\"><h1>" + escape_markup(recording.title) +
                     "</h1><span class=\"meta\">" + std::to_string(recording.agents.size()) +
                     (recording.agents.size() == 1 ? " agent, " : " agents, ") + std::to_string(frames) +
                     (frames == 1 ? " frame" : " frames");
  if (frames > 0) {
    text += ", ";
    append_number(text, recording.frames.back().time - recording.frames.front().time, 1);
    text += " s";
  }
  text += "</span></div><ul class=\"notes\">";
  for (std::string const& note : recording.notes) text += "<li>" + escape_markup(note) + "</li>";
  return text + "</ul></header>\n";
}

}  // namespace detail

CAMBIUM_COLD std::string html_replay(Recording const& recording) {
  check_recording(recording);
  std::string page = detail::page_begin(recording.title.empty() ? "Recording" : recording.title);
  page += detail::replay_style;
  page += "</style>\n</head>\n<body>\n" + detail::replay_header(recording);
  page += detail::replay_body;
  page +=
      "<script type=\"application/json\" id=\"recording\">\n" + detail::ReplayData(recording).json() + "\n</script>\n";
  page += "<script>(() => {";
  for (auto const script : {detail::page_script, detail::replay_scene_script, detail::replay_controls_script})
    page += script;
  page += "})();</script>\n</body>\n</html>\n";
  return page;
}

CAMBIUM_COLD void write_html_replay(std::filesystem::path const& path, Recording const& recording) {
  write_file(path, html_replay(recording));
}

}  // namespace cambium::inline v0_1
