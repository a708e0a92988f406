#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <boost/archive/archive_exception.hpp>
#include <boost/archive/polymorphic_binary_iarchive.hpp>
#include <boost/archive/polymorphic_binary_oarchive.hpp>
#include <boost/archive/polymorphic_text_iarchive.hpp>
#include <boost/archive/polymorphic_text_oarchive.hpp>
#include <boost/archive/polymorphic_xml_iarchive.hpp>
#include <boost/archive/polymorphic_xml_oarchive.hpp>

#include "cambium/core/error.hpp"
#include "cambium/core/hash.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/text.hpp"
#include "cambium/core/version.hpp"
#include "cambium/snapshot/snapshot.hpp"

/// A snapshot is a text and an archive:
///
///     cambium snapshot 1            version of this format
///     4012 9f86d081884c7d65         number of bytes after this line, and their checksum
///     archive binary                lines of the head
///     ...
///                                   an empty line, then the map, if there is one, then the archive
namespace cambium::inline v0_1::detail {

inline constexpr std::string_view snapshot_magic = "cambium snapshot ";
inline constexpr std::uint64_t snapshot_version = 1;

/// Writes the numbers of described structs directly: the same bytes as through Boost's layers, in less time.
class BinaryOut final : public boost::archive::polymorphic_binary_oarchive, public FieldSink {
 public:
  using boost::archive::polymorphic_binary_oarchive::polymorphic_binary_oarchive;

  void integer(char const*, std::uint64_t bits, std::size_t size, bool) override {
    with_integer(size, false, [&]<class Whole>(Whole) { put(static_cast<Whole>(bits)); });
  }
  void number(char const*, double value) override { put(value); }
  void number(char const*, float value) override { put(value); }

 private:
  template <class Number>
  void put(Number value) {
    boost::archive::binary_oarchive::save_binary(&value, sizeof value);
  }
};

class BinaryIn final : public boost::archive::polymorphic_binary_iarchive, public FieldSource {
 public:
  using boost::archive::polymorphic_binary_iarchive::polymorphic_binary_iarchive;

  [[nodiscard]] std::uint64_t integer(char const*, std::size_t size, bool is_signed) override {
    return with_integer(size, is_signed, [&](auto value) {
      get(value);
      return static_cast<std::uint64_t>(value);
    });
  }
  void number(char const*, double& value) override { get(value); }
  void number(char const*, float& value) override { get(value); }

 private:
  template <class Number>
  void get(Number& value) {
    boost::archive::binary_iarchive::load_binary(&value, sizeof value);
  }
};

/// A number for text archives, of which every bit survives; Boost's own cannot read infinities and NaN.
template <class Number>
[[nodiscard]] std::string exact_text(Number value) {
  if (std::isnan(value)) {
    auto const bits = std::bit_cast<std::conditional_t<sizeof(Number) == 8, std::uint64_t, std::uint32_t>>(value);
    return "nan:" + std::to_string(bits);
  }
  std::array<char, 40> text{};
  auto const end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}
template <class Number>
[[nodiscard]] Number exact_number(std::string const& text, std::string const& where = "snapshot") {
  using Bits = std::conditional_t<sizeof(Number) == 8, std::uint64_t, std::uint32_t>;
  Number value{};
  Bits bits{};
  bool const is_nan = text.starts_with("nan:");
  auto const* const begin = text.data() + (is_nan ? 4 : 0);
  auto const* const end = text.data() + text.size();
  auto const read = is_nan ? std::from_chars(begin, end, bits) : detail::from_chars(begin, end, value);
  if (read.ec != std::errc{} || read.ptr != end)
    throw SnapshotError(where, "'" + text.substr(0, 40) + "' is no number", "it is damaged: take another copy");
  return is_nan ? std::bit_cast<Number>(bits) : value;
}

class TextOut final : public boost::archive::polymorphic_text_oarchive {
 public:
  using boost::archive::polymorphic_text_oarchive::polymorphic_text_oarchive;

 private:
  void save(double const value) override { boost::archive::text_oarchive::save(exact_text(value)); }
  void save(float const value) override { boost::archive::text_oarchive::save(exact_text(value)); }
};

class TextIn final : public boost::archive::polymorphic_text_iarchive {
 public:
  using boost::archive::polymorphic_text_iarchive::polymorphic_text_iarchive;

 private:
  /// Boost allocates whatever length a file claims for a text; that of a number is short.
  template <class Number>
  void read(Number& value) {
    std::size_t length = 0;
    boost::archive::text_iarchive::load(length);
    if (length > 40) throw SnapshotError("snapshot", "a number is too long", "it is damaged: take another copy");
    std::string text(length, ' ');
    is.get();
    is.read(text.data(), static_cast<std::streamsize>(length));
    value = exact_number<Number>(text);
  }
  void load(double& value) override { read(value); }
  void load(float& value) override { read(value); }
};

/// Refuses values without a name: XML could not be read back.
class NamedXmlOut : public boost::archive::xml_oarchive {
 public:
  using boost::archive::xml_oarchive::xml_oarchive;

  void save_start(char const* key) {
    boost::archive::xml_oarchive::save_start(key);
    is_named_ = is_named_ || key != nullptr;  // Boost saves what an enum or a pointer holds without a key
  }
  void save_end(char const* key) {
    boost::archive::xml_oarchive::save_end(key);
    is_named_ = false;
  }
  template <class Value>
  void save(Value const& value) {
    take_name();
    if constexpr (std::is_floating_point_v<Value>)
      boost::archive::xml_oarchive::save(exact_text(value));
    else
      boost::archive::xml_oarchive::save(value);
  }
  void save_object(void const* object, boost::archive::detail::basic_oserializer const& serializer) {
    take_name();
    boost::archive::xml_oarchive::save_object(object, serializer);
  }

 private:
  void take_name() {
    if (!std::exchange(is_named_, false))
      throw SnapshotError("snapshot", "a member of a class has no name, which XML needs",
                          "write `archive & BOOST_SERIALIZATION_NVP(member)`, or take another format");
  }
  bool is_named_ = false;
};

class XmlOut final : public boost::archive::detail::polymorphic_oarchive_route<NamedXmlOut>,
                     public ArchiveSink<OutArchive> {
 public:
  XmlOut(std::ostream& stream, unsigned flags)
      : polymorphic_oarchive_route(stream, flags), ArchiveSink(static_cast<OutArchive&>(*this)) {}

  [[nodiscard]] bool has_tags() const override { return true; }
  void begin(char const* key) override { NamedXmlOut::save_start(key); }
  void end(char const* key) override { NamedXmlOut::save_end(key); }
  void text(char const* key, std::string const& text) override { ArchiveSink::put(key, text); }
};

class XmlIn final : public boost::archive::polymorphic_xml_iarchive, public ArchiveSource<InArchive> {
 public:
  XmlIn(std::istream& stream, unsigned flags)
      : polymorphic_xml_iarchive(stream, flags), ArchiveSource(static_cast<InArchive&>(*this)) {}

  [[nodiscard]] bool has_tags() const override { return true; }
  void begin(char const* key) override { boost::archive::xml_iarchive::load_start(key); }
  void end(char const* key) override { boost::archive::xml_iarchive::load_end(key); }
  [[nodiscard]] std::string text(char const* key) override {
    std::string text;
    ArchiveSource::get(key, text);
    return text;
  }

 private:
  template <class Number>
  void read(Number& value) {
    std::string text;
    boost::archive::xml_iarchive::load(text);
    value = exact_number<Number>(text);
  }
  void load(double& value) override { read(value); }
  void load(float& value) override { read(value); }
};

/// Boost's check of XML tags is off: it reads past the end of the expected name if the file's tag is longer.
inline constexpr unsigned plain_archive =
    boost::archive::no_header | boost::archive::no_codecvt | boost::archive::no_xml_tag_checking;

template <class Archive>
[[nodiscard]] std::string save_parts(std::span<SavedPart const> parts) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());  // whatever that of the host
  {
    Archive archive(stream, plain_archive);
    for (auto const& part : parts) part.archive(archive, part.name, part.object);
  }
  return std::move(stream).str();
}

template <class Archive>
void load_parts(std::string_view bytes, std::span<LoadedPart const> parts) {
  std::istringstream stream{std::string(bytes)};
  stream.imbue(std::locale::classic());
  {
    Archive archive(stream, plain_archive);
    for (auto const& part : parts) part.archive(archive, part.name, part.object);
  }
  bytes.remove_prefix(bytes.size() - static_cast<std::size_t>(stream.rdbuf()->in_avail()));
  if (std::is_same_v<Archive, TextIn> ? bytes.find_first_not_of('\n') != bytes.npos
                                      : !std::is_same_v<Archive, XmlIn> && !bytes.empty())  // XML ends by its tags
    throw SnapshotError("snapshot", "holds more than was read", "restore all that was saved, by the same `serialize`");
}

/// What a binary archive depends on: order of bytes, size of pointers and longs.
[[nodiscard]] inline std::string platform_tag() {
  std::string const order = std::endian::native == std::endian::little ? "little" : "big";
  return order + "-endian " + std::to_string(sizeof(void*)) + "/" + std::to_string(sizeof(long));
}

CAMBIUM_COLD std::string build_tag() {
#if defined(__clang__)
  std::string const compiler = "clang " __clang_version__;
#elif defined(__GNUC__)
  std::string const compiler = "gcc " __VERSION__;
#else
  std::string const compiler = "other compiler";
#endif
#if defined(__FMA__) || defined(__FP_FAST_FMA)
  std::string const fused = ", fused multiply-add";
#else
  std::string const fused;
#endif
#ifdef NDEBUG
  return compiler + fused + ", without asserts";
#else
  return compiler + fused + ", with asserts";
#endif
}

[[nodiscard]] inline std::optional<std::uint64_t> number_of(std::string_view text, int base) {
  std::uint64_t number = 0;
  auto const end = std::from_chars(text.data(), text.data() + text.size(), number, base);
  if (text.empty() || end.ec != std::errc{} || end.ptr != text.data() + text.size()) return std::nullopt;
  return number;
}

inline constexpr char const* format_names[] = {"binary", "text", "xml"};

template <class Parts>
[[nodiscard]] std::string names_of_parts(Parts const& parts) {
  std::string names;
  for (auto const& part : parts) names += (names.empty() ? "" : ", ") + std::string(part.name);
  return names;
}

CAMBIUM_COLD ArchivedParts archive_parts(SnapshotFormat format, SceneOfParts const& scene,
                                         std::span<SavedPart const> parts) {
  ArchivedParts archived{format, names_of_parts(parts), std::nullopt, scene.time, {}};
  if (scene.map != nullptr) archived.map_hash = hash_of_map(*scene.map);
  constexpr std::array save{&save_parts<BinaryOut>, &save_parts<TextOut>, &save_parts<XmlOut>};
  try {
    archived.archive = save[static_cast<std::size_t>(format)](parts);
  } catch (boost::archive::archive_exception const& problem) {
    throw SnapshotError("snapshot", std::string("no archive can hold its parts (") + problem.what() + ")",
                        "in XML, give names that are tags: letters, digits, _");
  }
  return archived;
}

CAMBIUM_COLD std::string with_head(ArchivedParts const& parts, SnapshotOptions const& options) {
  static std::string const build = build_tag(), platform = platform_tag();
  std::string body;
  body.reserve(512 + options.map_text.size() + parts.archive.size());
  auto const line = [&body](char const* key, std::string_view value) {
    body.append(key).append(" ").append(value).append("\n");
  };
  line("archive", format_names[static_cast<std::size_t>(parts.format)]);
  line("library", library_version);
  line("build", build);
  line("platform", platform);
  line("parts", parts.names);
  if (parts.map_hash) {
    line("time", exact_text(parts.time));
    line("map", hash_text(*parts.map_hash));
  }
  if (!options.map_file.empty()) line("map_file", printable(options.map_file));
  if (!options.map_text.empty()) line("map_bytes", std::to_string(options.map_text.size()));
  if (!options.component.empty()) line("component", printable(options.component));
  if (!options.note.empty()) line("note", printable(options.note));
  if (options.result) line("result", hash_text(*options.result));
  body.append("\n").append(options.map_text).append(parts.archive);
  std::string bytes(snapshot_magic);
  bytes +=
      std::to_string(snapshot_version) + "\n" + std::to_string(body.size()) + " " + hash_text(checksum_of(body)) + "\n";
  return bytes + body;
}

/// Takes a line from the begin of `text`, without its end; nothing if there is none.
[[nodiscard]] inline std::optional<std::string_view> take_line(std::string_view& text) {
  auto const end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  auto const line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

/// The texts in the head, by their keys.
inline constexpr std::pair<std::string_view, std::string SnapshotInfo::*> head_texts[] = {
    {"library", &SnapshotInfo::library},     {"build", &SnapshotInfo::build},
    {"platform", &SnapshotInfo::platform},   {"parts", &SnapshotInfo::parts},
    {"map_file", &SnapshotInfo::map_file},   {"note", &SnapshotInfo::note},
    {"component", &SnapshotInfo::component},
};

/// Takes what is before the archive from the begin of `bytes`: the lines of the head, and the map.
[[nodiscard]] inline SnapshotInfo take_info(std::string_view& bytes, std::string const& where) {
  SnapshotInfo info;
  std::size_t map_bytes = 0;
  bool is_known = false;
  for (auto line = take_line(bytes); line && !line->empty(); line = take_line(bytes)) {
    auto const gap = std::min(line->find(' '), line->size());
    auto const key = line->substr(0, gap);
    std::string const value(line->substr(std::min(gap + 1, line->size())));
    for (auto const& [name, text] : head_texts)
      if (key == name) info.*text = printable(value);
    if (key == "archive") {
      auto const* const format = std::find(std::begin(format_names), std::end(format_names), value);
      is_known = format != std::end(format_names);
      info.format = static_cast<SnapshotFormat>(format - format_names);
    } else if (key == "time") {
      info.time = exact_number<double>(value, where);
    } else if (key == "map") {
      info.map_hash = number_of(value, 16);
    } else if (key == "map_bytes") {
      map_bytes = static_cast<std::size_t>(number_of(value, 10).value_or(0));
    } else if (key == "result") {
      info.result = number_of(value, 16);
    }
  }
  if (!is_known) throw SnapshotError(where, "holds a kind of archive that is unknown", "read it with a newer program");
  if (map_bytes > bytes.size()) throw SnapshotError(where, "its map is cut short", "it is damaged: take another copy");
  info.map_text = bytes.substr(0, map_bytes);
  bytes.remove_prefix(map_bytes);
  return info;
}

/// Checks everything but the archive, which it leaves in `bytes`. Throws `SnapshotError` if the bytes are no snapshot,
/// damaged, or newer.
[[nodiscard]] inline SnapshotInfo open_snapshot(std::string_view& bytes, std::string const& where) {
  auto const damaged = [&where](std::string const& what) {
    throw SnapshotError(where, what, "it is damaged: take another copy");
  };
  if (!bytes.starts_with(snapshot_magic))
    throw SnapshotError(where, "is no snapshot of cambium", "give a file that save_snapshot has written");
  bytes.remove_prefix(snapshot_magic.size());
  auto const version = take_line(bytes);
  auto const number = version ? number_of(*version, 10) : std::nullopt;
  if (!number || *number == 0) damaged("its first line names no version");
  if (*number > snapshot_version)
    throw SnapshotError(where, "is of version " + std::to_string(*number) + " of the format, newer than this program",
                        "read it with the program that wrote it, or a newer one");
  auto const seal = take_line(bytes).value_or("");
  auto const size = number_of(seal.substr(0, seal.find(' ')), 10);
  if (!size) damaged("its second line names no length");
  if (*size != bytes.size())
    damaged((*size > bytes.size() ? "is cut short: " : "is too long: ") + std::to_string(bytes.size()) +
            " bytes instead of " + std::to_string(*size));
  if (*version != std::to_string(*number) || seal != std::to_string(*size) + " " + hash_text(checksum_of(bytes)))
    damaged("has a wrong checksum");
  return take_info(bytes, where);
}

CAMBIUM_COLD void read_snapshot(std::string_view bytes, std::string const& where, SceneOfParts const& scene,
                                std::span<LoadedPart const> parts) {
  auto const info = open_snapshot(bytes, where);
  if (auto const expected = names_of_parts(parts); info.parts != expected)
    throw SnapshotError(where, "holds the parts '" + info.parts + "', not '" + expected + "'",
                        "restore the same parts in the same order");
  if (info.format == SnapshotFormat::binary && info.platform != platform_tag())
    throw SnapshotError(where, "is binary and of another platform (" + info.platform + "; here " + platform_tag() + ")",
                        "write it as text there");
  if (scene.map != nullptr && info.map_hash && hash_of_map(*scene.map) != *info.map_hash)
    throw SnapshotError(where,
                        "was taken on another map: its hash is " + hash_text(*info.map_hash) +
                            ", that of the given one " + hash_text(hash_of_map(*scene.map)),
                        info.map_file.empty() ? "give the world the map that it was taken on"
                                              : "give the world the map of '" + info.map_file + "'");
  constexpr std::array load{&load_parts<BinaryIn>, &load_parts<TextIn>, &load_parts<XmlIn>};
  try {
    load[static_cast<std::size_t>(info.format)](bytes, parts);
  } catch (Error const& problem) {
    std::string_view what = problem.what();
    if (constexpr std::string_view place = "snapshot: "; what.starts_with(place)) what.remove_prefix(place.size());
    throw SnapshotError(where, what);
  } catch (std::exception const& problem) {  // of Boost.Serialization, or of memory
    throw SnapshotError(where, std::string("its archive cannot be read (") + problem.what() + ")",
                        "restore the same types as were saved, or take another copy");
  }
}

CAMBIUM_COLD std::uint64_t hash_of_parts(std::span<SavedPart const> parts) {
  return checksum_of(save_parts<BinaryOut>(parts));
}

}  // namespace cambium::inline v0_1::detail

namespace cambium::inline v0_1 {

CAMBIUM_COLD SnapshotInfo snapshot_info(std::string_view bytes, std::string const& where) {
  return detail::open_snapshot(bytes, where);
}

}  // namespace cambium::inline v0_1
