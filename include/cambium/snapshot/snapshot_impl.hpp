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
#include <istream>
#include <limits>
#include <locale>
#include <new>
#include <ostream>
#include <stdexcept>
#include <streambuf>
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
#include "cambium/core/version.hpp"
#include "cambium/snapshot/snapshot.hpp"

/// A snapshot is a text and an archive:
///
///     cambium snapshot 1            version of this format
///     4012 9f86d081884c7d65         number of bytes after this line, and their checksum
///     archive binary                lines of the head
///     ...
///                                   an empty line, then the map, if there is one, then the archive
namespace cambium::detail {

inline constexpr std::string_view snapshot_magic = "cambium snapshot ";
inline constexpr std::uint64_t snapshot_version = 1;

/// Writes to a string.
class StringSink final : public std::streambuf {
 public:
  explicit StringSink(std::string& text) : text_(text) {}

 protected:
  int_type overflow(int_type c) override {
    if (!traits_type::eq_int_type(c, traits_type::eof())) text_ += traits_type::to_char_type(c);
    return traits_type::not_eof(c);
  }
  std::streamsize xsputn(char const* data, std::streamsize size) override {
    text_.append(data, static_cast<std::size_t>(size));
    return size;
  }

 private:
  std::string& text_;
};

/// Reads from memory.
class StringSource final : public std::streambuf {
 public:
  explicit StringSource(std::string_view text) {
    auto* const begin = const_cast<char*>(text.data());  // a streambuf only reads what it gets from
    setg(begin, begin, begin + text.size());
  }
  [[nodiscard]] std::string_view rest() const { return {gptr(), egptr()}; }
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
  auto const read = is_nan ? std::from_chars(begin, end, bits) : std::from_chars(begin, end, value);
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

class XmlOut final : public boost::archive::detail::polymorphic_oarchive_route<NamedXmlOut>, public ArchiveTags {
 public:
  using Route = boost::archive::detail::polymorphic_oarchive_route<NamedXmlOut>;
  using Route::Route;

  void begin(char const* key) override { NamedXmlOut::save_start(key); }
  void end(char const* key) override { NamedXmlOut::save_end(key); }
};

class XmlIn final : public boost::archive::polymorphic_xml_iarchive, public ArchiveTags {
 public:
  using boost::archive::polymorphic_xml_iarchive::polymorphic_xml_iarchive;

  void begin(char const* key) override { boost::archive::xml_iarchive::load_start(key); }
  void end(char const* key) override { boost::archive::xml_iarchive::load_end(key); }

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

/// Without Boost's comparison of tags: where that of a file is longer than the name expected, it reads behind the name.
inline constexpr unsigned plain_archive =
    boost::archive::no_header | boost::archive::no_codecvt | boost::archive::no_xml_tag_checking;

template <class Archive>
void save_parts(std::string& bytes, std::span<SavedPart const> parts) {
  StringSink sink(bytes);
  std::ostream stream(&sink);
  stream.imbue(std::locale::classic());  // whatever that of the host
  Archive archive(stream, plain_archive);
  for (auto const& part : parts) part.save(archive, part.name, part.object);
}

template <class Archive>
void load_parts(std::string_view bytes, std::span<LoadedPart const> parts) {
  StringSource source(bytes);
  std::istream stream(&source);
  stream.imbue(std::locale::classic());
  {
    Archive archive(stream, plain_archive);
    for (auto const& part : parts) part.load(archive, part.name, part.object);
  }
  auto const rest = source.rest();
  if (std::is_same_v<Archive, TextIn> ? rest.find_first_not_of('\n') != rest.npos
                                      : !std::is_same_v<Archive, XmlIn> && !rest.empty())  // XML ends by its tags
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

[[nodiscard]] inline std::string hex(std::uint64_t number) {
  std::string text(16, '0');
  for (std::size_t i = 0; i < 16; ++i) text[15 - i] = "0123456789abcdef"[number >> (4 * i) & 15u];
  return text;
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
  archived.archive.reserve(8192);
  try {
    switch (format) {
      case SnapshotFormat::binary:
        save_parts<boost::archive::polymorphic_binary_oarchive>(archived.archive, parts);
        break;
      case SnapshotFormat::text:
        save_parts<TextOut>(archived.archive, parts);
        break;
      case SnapshotFormat::xml:
        save_parts<XmlOut>(archived.archive, parts);
        break;
    }
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
    line("map", hex(*parts.map_hash));
  }
  if (!options.map_file.empty()) line("map_file", printable(options.map_file));
  if (!options.map_text.empty()) line("map_bytes", std::to_string(options.map_text.size()));
  if (!options.component.empty()) line("component", printable(options.component));
  if (!options.note.empty()) line("note", printable(options.note));
  if (options.result) line("result", hex(*options.result));
  body.append("\n").append(options.map_text).append(parts.archive);
  std::string bytes(snapshot_magic);
  bytes += std::to_string(snapshot_version) + "\n" + std::to_string(body.size()) + " " + hex(checksum_of(body)) + "\n";
  return bytes + body;
}

/// The head of a snapshot, and its archive.
struct OpenedSnapshot {
  SnapshotInfo info;
  std::string_view archive;
};

/// Takes a line from the begin of `text`, without its end; nothing if there is none.
[[nodiscard]] inline std::optional<std::string_view> take_line(std::string_view& text) {
  auto const end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  auto const line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

/// Checks everything but the archive. Throws `SnapshotError` if the bytes are no snapshot, damaged, or newer.
[[nodiscard]] inline OpenedSnapshot open_snapshot(std::string_view bytes, std::string const& where) {
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
  auto const length = seal.substr(0, seal.find(' '));
  auto const size = number_of(length, 10);
  if (!size) damaged("its second line names no length");
  if (*size != bytes.size())
    damaged((*size > bytes.size() ? "is cut short: " : "is too long: ") + std::to_string(bytes.size()) +
            " bytes instead of " + std::to_string(*size));
  if (*version != std::to_string(*number) || seal != std::to_string(*size) + " " + hex(checksum_of(bytes)))
    damaged("has a wrong checksum");
  OpenedSnapshot opened;
  auto& info = opened.info;
  std::uint64_t map_bytes = 0;
  bool is_known = false;
  for (auto line = take_line(bytes); line && !line->empty(); line = take_line(bytes)) {
    auto const gap = std::min(line->find(' '), line->size());
    auto const key = line->substr(0, gap);
    std::string const value(line->substr(std::min(gap + 1, line->size())));
    if (key == "archive") {
      for (std::size_t i = 0; i < std::size(format_names); ++i)
        if (value == format_names[i]) {
          info.format = static_cast<SnapshotFormat>(i);
          is_known = true;
        }
    } else if (key == "time") {
      info.time = exact_number<double>(value, where);
    } else if (key == "map") {
      info.map_hash = number_of(value, 16);
    } else if (key == "map_bytes") {
      map_bytes = number_of(value, 10).value_or(0);
    } else if (key == "result") {
      info.result = number_of(value, 16);
    } else {
      auto* const text = key == "library"     ? &info.library
                         : key == "build"     ? &info.build
                         : key == "platform"  ? &info.platform
                         : key == "parts"     ? &info.parts
                         : key == "map_file"  ? &info.map_file
                         : key == "component" ? &info.component
                         : key == "note"      ? &info.note
                                              : nullptr;
      if (text != nullptr) *text = printable(value);
    }
  }
  if (!is_known) throw SnapshotError(where, "holds a kind of archive that is unknown", "read it with a newer program");
  if (map_bytes > bytes.size()) damaged("its map is cut short");
  info.map_text = bytes.substr(0, static_cast<std::size_t>(map_bytes));
  opened.archive = bytes.substr(static_cast<std::size_t>(map_bytes));
  return opened;
}

CAMBIUM_COLD void read_snapshot(std::string_view bytes, std::string const& where, SceneOfParts const& scene,
                                std::span<LoadedPart const> parts) {
  auto const [info, archive] = open_snapshot(bytes, where);
  if (auto const expected = names_of_parts(parts); info.parts != expected)
    throw SnapshotError(where, "holds the parts '" + info.parts + "', not '" + expected + "'",
                        "restore the same parts in the same order");
  if (info.format == SnapshotFormat::binary && info.platform != platform_tag())
    throw SnapshotError(where, "is binary and of another platform (" + info.platform + "; here " + platform_tag() + ")",
                        "write it as text there");
  if (scene.map != nullptr && info.map_hash && hash_of_map(*scene.map) != *info.map_hash)
    throw SnapshotError(where,
                        "was taken on another map: its hash is " + hex(*info.map_hash) + ", that of the given one " +
                            hex(hash_of_map(*scene.map)),
                        info.map_file.empty() ? "give the world the map that it was taken on"
                                              : "give the world the map of '" + info.map_file + "'");
  try {
    switch (info.format) {
      case SnapshotFormat::binary:
        load_parts<boost::archive::polymorphic_binary_iarchive>(archive, parts);
        break;
      case SnapshotFormat::text:
        load_parts<TextIn>(archive, parts);
        break;
      case SnapshotFormat::xml:
        load_parts<XmlIn>(archive, parts);
        break;
    }
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
  std::string bytes;
  bytes.reserve(8192);
  save_parts<boost::archive::polymorphic_binary_oarchive>(bytes, parts);
  return checksum_of(bytes);
}

}  // namespace cambium::detail

namespace cambium {

CAMBIUM_COLD SnapshotInfo snapshot_info(std::string_view bytes, std::string const& where) {
  return detail::open_snapshot(bytes, where).info;
}

}  // namespace cambium
