#pragma once

#include <boost/serialization/level.hpp>
#include <boost/serialization/tracking.hpp>

#include "cambium/core/parameters.hpp"
#include "cambium/snapshot/detail/field_reader.hpp"
#include "cambium/snapshot/detail/field_writer.hpp"

namespace cambium::detail {

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
  if constexpr (Archive::is_saving::value)
    cambium::detail::FieldWriter(archive).write(cambium::detail::struct_name<T>(), object);
  else
    cambium::detail::FieldReader(archive).read(cambium::detail::struct_name<T>(), object);
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
