#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/nearest_names.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/text.hpp"
#include "cambium/core/transfer_parameters.hpp"

namespace cambium {

namespace detail {

/// Sets one number of a described struct by its key. Elements of lists have no such key.
class KeyedNumber final : public ParameterTransfer {
 public:
  KeyedNumber(std::string_view key, double number, std::string const& where)
      : key_(key), parts_(split(key, ".")), number_(number), where_(where) {}

  [[nodiscard]] bool is_found() const { return found_; }
  /// The first part of the key that is unknown, and what is there instead.
  [[nodiscard]] std::string remedy() const {
    return deepest_ < parts_.size() ? suggestion(parts_[deepest_], beside_) : "name a number in it";
  }

  [[nodiscard]] bool field(char const* key) override {
    if (in_list_ > 0 || found_ || depth() == parts_.size()) return false;
    if (parts_[depth()] == key) {
      beside_.clear();
      deepest_ = depth() + 1;
      entered_.push_back(depth() + 1);
      return true;
    }
    if (depth() == deepest_) beside_.emplace_back(key);
    return false;
  }
  void element(std::size_t) override { ++in_list_; }
  void end() override {
    if (in_list_ > 0)
      --in_list_;
    else
      entered_.pop_back();
  }
  void begin_struct() override {}
  void end_struct() override {}
  [[nodiscard]] std::size_t list(std::size_t length, std::size_t, bool) override { return length; }
  [[nodiscard]] std::size_t alternative(std::span<char const* const> names, std::size_t now, std::size_t) override {
    if (entered_.empty() || in_list_ > 0) return now;
    bool const is_named = depth() < parts_.size() && parts_[depth()] == alternative_name(names, now);
    if (!is_named && depth() == deepest_) beside_ = {std::string(alternative_name(names, now))};
    entered_.back() = is_named ? depth() + 1 : parts_.size();
    return now;
  }
  [[nodiscard]] bool presence(bool now) override { return now; }
  [[nodiscard]] ParameterValue value(ParameterInfo const& info, ParameterValue const& now, bool, ParameterValue const&,
                                     ParameterValue const&) override {
    if (in_list_ > 0 || depth() != parts_.size()) return now;
    if (!now.is_real()) throw ParameterError(where(), "is no real number", "name another parameter");
    auto changed = now;
    changed.number = number_;
    if (!changed.in(info.range))
      throw ParameterError(where(), "is " + with_unit(number_text(number_), info.unit),
                           "give a value in " + with_unit(range_text(info), info.unit));
    found_ = true;
    return changed;
  }
  void text(std::string&, bool) override {}
  [[nodiscard]] std::string where() const override { return (where_.empty() ? "" : where_ + ": ") + std::string(key_); }

 private:
  [[nodiscard]] std::size_t depth() const { return entered_.empty() ? 0 : entered_.back(); }

  std::string_view key_;
  std::vector<std::string_view> parts_;
  double number_;
  std::string const& where_;
  std::vector<std::size_t> entered_;  ///< number of parts that lead to each field entered
  std::size_t deepest_ = 0;
  int in_list_ = 0;
  bool found_ = false;
  std::vector<std::string> beside_;
};

inline void set_number(void* object, void const* usual, TransferStruct transfer, std::string_view key, double number,
                       std::string const& where) {
  KeyedNumber setter(key, number, where);
  transfer(object, usual, setter);
  if (!setter.is_found()) throw ParameterError(setter.where(), "there is no number of that key", setter.remedy());
}

}  // namespace detail

/// Sets the real number of a described struct that `key` names: "desired_speed", "idm.desired_speed". Throws
/// `ParameterError` at `where` if there is none (with the nearest key), or if `number` is out of its range. O(fields of
/// the structs that the key names).
template <Described T>
void set_parameter(T& object, std::string_view key, double number, std::string const& where = {}) {
  T const usual{};
  detail::set_number(&object, &usual, &detail::transfer_any<T>, key, number, where);
}

}  // namespace cambium
