#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <variant>

#include <boost/serialization/nvp.hpp>
#include <boost/serialization/string.hpp>

#include "cambium/core/parameters.hpp"
#include "cambium/snapshot/detail/archived_types.hpp"
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

/// Calls `f` between the tags `key`.
template <class F>
void tagged(ArchiveTags* tags, char const* key, F const& f) {
  if (tags != nullptr) tags->begin(key);
  f();
  if (tags != nullptr) tags->end(key);
}

/// Writes described structs to an archive of Boost.Serialization.
///
///     struct:       once a type its version, number of fields and a hash of their names; then each field, or, where
///                   the reader has a similar struct already, bits for the fields that differ, and these
///     alternative:  a number; with a new one the name
///     list:         the length; each element by what differs from the one before
template <class Archive>
class FieldWriter {
 public:
  explicit FieldWriter(Archive& archive) : archive_(archive) {}

  /// `like`: what the reader has already; null if nothing.
  template <class Value>
  void write(char const* key, Value const& value, Value const* like = nullptr) {
    if constexpr (Described<Value>) {
      tagged(tags_, key, [&] { write_struct(value, like); });
    } else if constexpr (std::is_same_v<Value, std::string>) {
      put_text(key, value);
    } else if constexpr (Variant<Value>) {
      tagged(tags_, key, [&] { write_alternative(value); });
    } else if constexpr (Optional<Value>) {
      tagged(tags_, key, [&] {
        put("present", stored(value.has_value()));
        if (value) write("value", *value, like != nullptr && *like ? &**like : nullptr);
      });
    } else if constexpr (ParameterList<Value>) {
      tagged(tags_, key, [&] { write_list(value, like); });
    } else if constexpr (is_long_unsigned<Value>) {
      put_whole(key, static_cast<std::uint64_t>(value));
    } else {
      put(key, stored(value));
    }
  }

 private:
  template <class Value>
  void put(char const* key, Value const& value) {
    archive_ << boost::serialization::make_nvp(key, value);
  }

  void put_count(char const* key, std::size_t count) {
    if (count > ArchivedTypes::longest)
      throw SnapshotError("snapshot", "a list has " + std::to_string(count) + " elements",
                          "an archive holds 16 million");
    put_whole(key, count);
  }
  /// A whole number, of which most are small: in one byte, or in 9.
  void put_whole(char const* key, std::uint64_t number) {
    put(key, static_cast<unsigned char>(number < 255 ? number : 255));
    if (number >= 255) put("whole", number);
  }

  /// Letter by letter, except in XML: for a whole text, Boost allocates whatever length a file claims.
  void put_text(char const* key, std::string const& text) {
    if (tags_ != nullptr) return put(key, text);
    put_count(key, text.size());
    for (char const letter : text) put(key, letter);
  }

  void write_shape(KnownStruct const& type) {
    if (types_.shape(type) != nullptr) return;
    put("fields", static_cast<unsigned char>(type.fields + (type.version > 0 ? 128 : 0)));
    if (type.version > 0) put_whole("version", type.version);
    put("names", type.hashes[type.fields]);
    types_.add({&type, type.version, type.fields});
  }

  [[noreturn]] static void refuse_depth(char const* name) {
    throw SnapshotError("snapshot",
                        std::string("a struct '") + name + "' lies within more than " +
                            std::to_string(ArchivedTypes::deepest) + " others",
                        "nest fewer of them");
  }

  template <Described T>
  void write_struct(T const& object, T const* like) {
    constexpr std::size_t fields = field_count<T>();
    static_assert(fields < 128, "cambium: a struct with more than 127 fields is too large for snapshots; nest some");
    if (++depth_ > ArchivedTypes::deepest) refuse_depth(struct_name<T>());
    write_shape(known_struct<T>);
    std::array<unsigned char, (fields + 7) / 8> differs{};
    std::size_t i = 0;
    if (like != nullptr) {
      for_each_parameter<T>([&](auto const& p) {
        if (!same_bits(object.*p.field, like->*p.field))
          differs[i / 8] = static_cast<unsigned char>(differs[i / 8] | 1u << i % 8);
        ++i;
      });
      for (auto const& bits : differs) put("differs", bits);
    } else {
      differs.fill(0xff);
    }
    i = 0;
    for_each_parameter<T>([&](auto const& p) {
      if ((differs[i / 8] >> i % 8 & 1u) != 0)
        write(p.name, object.*p.field, like != nullptr ? &(like->*p.field) : nullptr);
      ++i;
    });
    --depth_;
  }

  template <class... Models>
  void write_alternative(std::variant<Models...> const& value) {
    auto const names = names_of(value);
    auto const index = value.index();
    if (names[index] == nullptr)
      throw SnapshotError("snapshot", "a struct is not described, or has no default: no archive can hold it",
                          "give it `name` and `parameters()`");
    auto const* const key = &type_key<std::variant<Models...>>;
    auto const number = types_.number_of(key, index);
    put_whole("alternative", number);
    if (number == types_.alternatives().size()) {
      types_.alternatives().push_back({key, index});
      put_text("name", alternative_name(names, index));
    }
    with_alternative(value, [&]<class Model>(Model const& model, auto) {
      if constexpr (Described<Model>) {
        write(struct_name<Model>(), model, static_cast<Model const*>(types_.alternatives()[number].last.get()));
        types_.alternatives()[number].last = std::shared_ptr<void const>(std::shared_ptr<void>(), &model);  // not owned
      }
    });
  }

  template <ParameterList Value>
  void write_list(Value const& value, Value const* like) {
    auto const elements = elements_of(value);
    auto const known = like != nullptr ? elements_of(*like) : std::span<ElementOf<Value> const>();
    put_count("length", elements.size());
    for (std::size_t i = 0; i < elements.size(); ++i)
      write("item", elements[i], i < known.size() ? &known[i] : i > 0 ? &elements[i - 1] : nullptr);
  }

  Archive& archive_;
  ArchiveTags* tags_ = tags_of(archive_);
  ArchivedTypes types_;
  int depth_ = 0;
};

}  // namespace cambium::detail
