#pragma once

#include <filesystem>
#include <string>

#include "cambium/viewer/recording.hpp"

namespace cambium::inline v0_1 {

/// An HTML page that plays the recording in any browser of 2023 or later, without further files or a network. UTF-8;
/// the same recording gives the same bytes. Positions are rounded to 1 cm, headings to 1 mrad, speeds to 1 cm/s, times
/// to 1 ms. Agents whose position or heading is not finite are not shown. For tests, `<body data-ready="frames">`
/// appears once the first frame is drawn, `data-frame` is the frame shown, and the page reads `#frame=K`, `#play` and
/// `#probe=x,y` from its address. Throws `Error` as `check_recording` does. O(numbers written + pieces of lane borders
/// × lanes).
[[nodiscard]] std::string html_replay(Recording const& recording);

/// Writes `html_replay(recording)` to `path`; the file appears only when it is complete. Throws `Error` naming the path
/// and the reason when it cannot be written.
void write_html_replay(std::filesystem::path const& path, Recording const& recording);

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/viewer/html_replay_impl.hpp"
#endif
