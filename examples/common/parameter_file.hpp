#pragma once

#include <memory>
#include <string>

#include "cambium/core/parameters.hpp"
#include "cambium/core/type_info.hpp"

namespace CLI {
class App;
}

namespace examples {

/// What `--parameters FILE` says: a JSON object with a member for each struct of parameters, by its name.
///
///   {"format": 1, "mobil": {"law": {"desired_speed": 30}, "lateral": {"rule": {"politeness": 0.5}}}}
///
/// What the file does not say stays as the program has it: its own value, or what it draws for each driver. All
/// functions throw `cambium::ParameterError` that names file and key.
class ParameterFile {
 public:
  /// Adds `--parameters` and `--print-parameters`.
  void add_options(CLI::App& program);

  /// Declares that the file may have a member of this name, and sets in `object` what it says.
  template <cambium::Described T>
  void take(T& object, std::string const& name = T::name) {
    know(name);
    set(object, name);
    show(object, name);
  }

  /// Declares that the file may have a member of this name, and checks it.
  template <cambium::Described T>
  void allow(std::string const& name = T::name) {
    know(name);
    T usual{};
    set(usual, name);
  }

  /// Sets in `object` what the file says. May be called from many threads.
  template <cambium::Described T>
  void set(T& object, std::string const& name = T::name) const {
    if (!has(name)) return;
    T changed = object;
    read(name, cambium::type_info<T>(), &changed);
    object = changed;
  }

  /// Notes the values of a struct for `--print-parameters`. Of several structs of one name, what they have in common is
  /// printed.
  template <cambium::Described T>
  void show(T const& object, std::string const& name = T::name) {
    if (prints_) show_values(name, cambium::type_info<T>(), &object);
  }

  /// The file; empty if none was given.
  [[nodiscard]] std::string const& path() const { return path_; }

  /// Whether `--print-parameters` was given.
  [[nodiscard]] bool prints() const { return prints_; }

  /// Throws if the file has a member that was not declared. Prints what was shown, if that is asked for; returns
  /// whether, and then the program is done.
  [[nodiscard]] bool finish();

 private:
  struct Content;

  void know(std::string const& name);
  [[nodiscard]] bool has(std::string const& name) const;
  void read(std::string const& name, cambium::TypeInfo const& type, void* object) const;
  void show_values(std::string const& name, cambium::TypeInfo const& type, void const* object);

  std::string path_;
  bool prints_ = false;
  std::shared_ptr<Content> content_;
};

}  // namespace examples
