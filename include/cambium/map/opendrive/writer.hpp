#pragma once

#include <filesystem>
#include <string>

#include "cambium/map/opendrive/document.hpp"

namespace cambium::inline v0_1::map {

/// The document as an OpenDRIVE file: UTF-8, numbers as short as they can be for the same value to be read again. What
/// the reader makes of it equals the document (but for characters that XML cannot hold, which become U+FFFD, and for
/// documents that no reader makes: with an id missing, say, or a cubic whose parameter ends elsewhere than at 1 or at
/// the length). Throws `MapError` where a number is not finite or a name of the rest is none that XML allows. Linear.
[[nodiscard]] std::string write_opendrive(OpenDriveDocument const& document);

/// Writes the document to a file, which a reader never meets half written. Throws as above, and `Error` naming the path
/// and the system's reason where the file cannot be written.
void write_opendrive(std::filesystem::path const& path, OpenDriveDocument const& document);

}  // namespace cambium::inline v0_1::map

namespace cambium::inline v0_1 {
using map::write_opendrive;
}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/map/opendrive/writer_impl.hpp"
#endif
