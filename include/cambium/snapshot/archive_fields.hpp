#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include <boost/serialization/level.hpp>
#include <boost/serialization/nvp.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/tracking.hpp>

#include "cambium/core/binary.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/type_info.hpp"
#include "cambium/snapshot/snapshot_error.hpp"

namespace cambium::detail {

/// The nested tags of an archive that has some, for readers of the file.
class ArchiveTags {
 public:
  virtual void begin(char const* key) = 0;
  virtual void end(char const* key) = 0;

 protected:
  ~ArchiveTags() = default;
};

/// Those of `archive`; null if it has none.
template <class Archive>
[[nodiscard]] ArchiveTags* tags_of(Archive& archive) {
  if constexpr (std::is_polymorphic_v<Archive>)
    return dynamic_cast<ArchiveTags*>(&archive);
  else
    return nullptr;
}

/// Writes fields to an archive of Boost.Serialization.
template <class Archive>
class ArchiveSink final : public FieldSink {
 public:
  explicit ArchiveSink(Archive& archive) : archive_(archive) {}

  void integer(char const* key, std::uint64_t bits, std::size_t size, bool is_signed) override {
    with_integer(size, is_signed, [&]<class Whole>(Whole) { put(key, static_cast<Whole>(bits)); });
  }
  void number(char const* key, double value) override { put(key, value); }
  void number(char const* key, float value) override { put(key, value); }
  [[nodiscard]] bool has_tags() const override { return tags_ != nullptr; }
  void begin(char const* key) override { tags_->begin(key); }
  void end(char const* key) override { tags_->end(key); }
  void text(char const* key, std::string const& text) override { put(key, text); }

 private:
  template <class Value>
  void put(char const* key, Value const& value) {
    archive_ << boost::serialization::make_nvp(key, value);
  }

  Archive& archive_;
  ArchiveTags* tags_ = tags_of(archive_);
};

template <class Archive>
class ArchiveSource final : public FieldSource {
 public:
  explicit ArchiveSource(Archive& archive) : archive_(archive) {}

  [[nodiscard]] std::uint64_t integer(char const* key, std::size_t size, bool is_signed) override {
    return with_integer(size, is_signed, [&]<class Whole>(Whole value) {
      get(key, value);
      return static_cast<std::uint64_t>(value);
    });
  }
  void number(char const* key, double& value) override { get(key, value); }
  void number(char const* key, float& value) override { get(key, value); }
  [[nodiscard]] bool has_tags() const override { return tags_ != nullptr; }
  void begin(char const* key) override { tags_->begin(key); }
  void end(char const* key) override { tags_->end(key); }
  [[nodiscard]] std::string text(char const* key) override {
    std::string text;
    get(key, text);
    return text;
  }

 private:
  template <class Value>
  void get(char const* key, Value& value) {
    archive_ >> boost::serialization::make_nvp(key, value);
  }

  Archive& archive_;
  ArchiveTags* tags_ = tags_of(archive_);
};

/// Saves `value`, whose fields are described, or loads it. Throws `SnapshotError` as `write_fields` and `read_fields`
/// throw `ParameterError`.
template <class Archive, class Value>
void archive_fields(Archive& archive, char const* key, Value& value) {
  try {
    if constexpr (Archive::is_saving::value) {
      ArchiveSink<Archive> sink(archive);
      write_fields(sink, key, type_info<std::remove_const_t<Value>>(), &value, "snapshot");
    } else {
      ArchiveSource<Archive> source(archive);
      read_fields(source, key, type_info<Value>(), &value, "snapshot");
    }
  } catch (ParameterError const& problem) {
    std::string_view what = problem.what();
    if (constexpr std::string_view place = "snapshot: "; what.starts_with(place)) what.remove_prefix(place.size());
    throw SnapshotError("snapshot", what);
  }
}

/// Whether this library writes `T` field by field, without what Boost notes of classes.
template <class T>
inline constexpr bool is_archived_by_fields = Described<T>;

/// Whether a struct has a public member `serialize`, which then counts instead of its description.
template <class T, class Archive>
concept SerializesItself = requires(T object, Archive& archive) {
  object.serialize(archive, 0u);
};

}  // namespace cambium::detail

namespace boost::serialization {

/// A described struct, also as a member of a class of one's own: `archive & driver_`.
template <class Archive, cambium::Described T>
requires(!cambium::detail::SerializesItself<T, Archive>) void serialize(Archive& archive, T& object, unsigned) {
  cambium::detail::archive_fields(archive, cambium::detail::struct_name<T>(), object);
}

template <class T>
requires(cambium::detail::is_archived_by_fields<T>) struct implementation_level<T> {
  using tag = mpl::integral_c_tag;
  using type = mpl::int_<object_serializable>;
  static constexpr int value = object_serializable;
};

template <class T>
requires(cambium::detail::is_archived_by_fields<T>) struct tracking_level<T> {
  using tag = mpl::integral_c_tag;
  using type = mpl::int_<track_never>;
  static constexpr int value = track_never;
};

}  // namespace boost::serialization
