#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "cambium/viewer/recording.hpp"

namespace cambium::inline v0_1 {

/// What `svg_picture` shows.
struct SvgOptions {
  double width = 1200.0;               ///< width of the picture [px], at least 100; the height follows from the map
  bool labels = true;                  ///< title, lane labels and scale bars
  std::optional<std::size_t> frame{};  ///< draws the vehicles of this frame
};

/// A picture of the map as SVG text, with the vehicles of frame `options.frame` if that is set. North is up. If the map
/// is too long to show its lanes at this width, a close-up is added below, turned along the road and outlined in the
/// overview. The same recording and options give the same bytes. Throws `Error` as `check_recording` does, and if the
/// recording has no such frame or the width is below 100 px.
[[nodiscard]] std::string svg_picture(Recording const& recording, SvgOptions const& options = {});

/// Writes `svg_picture(recording, options)` to `path`; the file appears only when it is complete. Throws `Error` naming
/// the path and the reason when it cannot be written.
void write_svg_picture(std::filesystem::path const& path, Recording const& recording, SvgOptions const& options = {});

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/viewer/svg_picture_impl.hpp"
#endif
