#pragma once

#include <cstddef>
#include <cstdint>
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

namespace cambium::inline v0_1::detail {

/// Writes fields to an archive of Boost.Serialization.
template <class Archive>
class ArchiveSink : public FieldSink {
 public:
  explicit ArchiveSink(Archive& archive) : archive_(archive) {}

  void integer(char const* key, std::uint64_t bits, std::size_t size, bool is_signed) override {
    with_integer(size, is_signed, [&]<class Whole>(Whole) { put(key, static_cast<Whole>(bits)); });
  }
  void number(char const* key, double value) override { put(key, value); }
  void number(char const* key, float value) override { put(key, value); }

 protected:
  ~ArchiveSink() = default;
  template <class Value>
  void put(char const* key, Value const& value) {
    archive_ << boost::serialization::make_nvp(key, value);
  }

 private:
  Archive& archive_;
};

template <class Archive>
class ArchiveSource : public FieldSource {
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

 protected:
  ~ArchiveSource() = default;
  template <class Value>
  void get(char const* key, Value& value) {
    archive_ >> boost::serialization::make_nvp(key, value);
  }

 private:
  Archive& archive_;
};

/// Calls `f` with the archive itself if it is a `Fields` (`FieldSink` or `FieldSource`), as some archives of snapshots
/// are; otherwise with an `Adapter` to it.
template <class Fields, class Adapter, class Archive, class F>
void with_fields(Archive& archive, F const& f) {
  if constexpr (std::is_polymorphic_v<Archive>)
    if (auto* const own = dynamic_cast<Fields*>(&archive)) return f(*own);
  struct Usual final : Adapter {
    using Adapter::Adapter;
  } usual(archive);
  f(usual);
}

/// Saves `value`, whose fields are described, or loads it. Throws `SnapshotError` as `write_fields` and `read_fields`
/// throw `ParameterError`.
template <class Archive, class Value>
void archive_fields(Archive& archive, char const* key, Value& value) {
  try {
    auto const& type = type_info<std::remove_const_t<Value>>();
    if constexpr (Archive::is_saving::value)
      with_fields<FieldSink, ArchiveSink<Archive>>(
          archive, [&](FieldSink& sink) { write_fields(sink, key, type, &value, "snapshot"); });
    else
      with_fields<FieldSource, ArchiveSource<Archive>>(
          archive, [&](FieldSource& source) { read_fields(source, key, type, &value, "snapshot"); });
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

}  // namespace cambium::inline v0_1::detail

namespace boost::serialization {

/// A described struct, also as a member of your own class: `archive & driver_`.
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
