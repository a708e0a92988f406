#include "parameter_file.hpp"

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "cambium/core/json.hpp"
#include "cambium/core/nearest_names.hpp"
#include "cambium/core/read_file.hpp"

#include "command_line.hpp"

namespace examples {

namespace {

using cambium::ParameterError;
using cambium::detail::JsonValue;
using Members = std::vector<JsonValue::Member>;

JsonValue const* find(Members const& members, std::string const& name) {
  auto const at = std::find_if(members.begin(), members.end(), [&](auto const& one) { return one.first == name; });
  return at == members.end() ? nullptr : &at->second;
}

bool are_equal(JsonValue const& a, JsonValue const& b) {
  return cambium::detail::print_json(a) == cambium::detail::print_json(b);
}

/// Removes what is not the same in `other`.
void keep_common(JsonValue& value, JsonValue const& other) {
  auto* const members = std::get_if<Members>(&value.value);
  if (members == nullptr || other.members() == nullptr) return;
  std::erase_if(*members, [&](JsonValue::Member& member) {
    auto const* const twin = find(*other.members(), member.first);
    if (twin == nullptr) return true;
    if (are_equal(member.second, *twin)) return false;
    keep_common(member.second, *twin);
    auto const* const left = member.second.members();
    return left == nullptr || left->empty();
  });
}

}  // namespace

struct ParameterFile::Content {
  Members said;                    ///< by the file
  std::vector<std::string> known;  ///< names that it may have
  Members shown;
};

void ParameterFile::add_options(CLI::App& program) {
  program
      .add_option("--parameters", path_,
                  "JSON file of parameters, such as {\"idm\": {\"law\": {\"desired_speed\": 12}}}; --print-parameters "
                  "shows one")
      ->type_name("FILE")
      ->check(not_empty());
  program.add_flag("--print-parameters", prints_,
                   "print the parameters as such a file, without those that are drawn for each driver, and exit");
}

void ParameterFile::know(std::string const& name) {
  if (!content_) {
    content_ = std::make_shared<Content>();
    if (!path_.empty()) {
      auto document = cambium::detail::parse_json(
          cambium::read_file<cambium::Error>(path_, {.expected = "give a JSON file"}), path_);
      auto* const members = std::get_if<Members>(&document.value);
      if (members == nullptr)
        throw ParameterError(path_, std::string("is ") + document.kind(),
                             "give an object with a member for each struct, as --print-parameters prints it");
      content_->said = std::move(*members);
    }
  }
  if (std::find(content_->known.begin(), content_->known.end(), name) == content_->known.end())
    content_->known.push_back(name);
}

bool ParameterFile::has(std::string const& name) const {
  if (!content_ || std::find(content_->known.begin(), content_->known.end(), name) == content_->known.end())
    throw std::logic_error("parameters " + name + ": declare them by allow() or take() first");
  return find(content_->said, name) != nullptr;
}

void ParameterFile::read(std::string const& name, cambium::TypeInfo const& type, void* object) const {
  cambium::detail::read_json_value(*find(content_->said, name), type, object, name.c_str(), path_, nullptr);
  cambium::detail::check_values(type, object, name.c_str(), path_);
}

void ParameterFile::show_values(std::string const& name, cambium::TypeInfo const& type, void const* object) {
  auto const own = cambium::detail::json_value(type, object, cambium::JsonDetail::everything, nullptr);
  for (auto& [shown, value] : content_->shown)
    if (shown == name) return keep_common(value, own);
  content_->shown.push_back({name, own});
}

bool ParameterFile::finish() {
  if (!content_) return false;
  for (auto const& [name, value] : content_->said) {
    if (name == "format") {
      if (!are_equal(value, {std::uint64_t{1}}))
        throw ParameterError(path_ + ": format", "is not 1, the one that this version reads", "write \"format\": 1");
    } else if (std::find(content_->known.begin(), content_->known.end(), name) == content_->known.end()) {
      throw ParameterError(path_, "this program has no parameters \"" + name + "\"",
                           cambium::detail::suggestion(name, content_->known));
    }
  }
  if (!prints_) return false;
  Members file{{"format", {std::uint64_t{1}}}};
  file.insert(file.end(), content_->shown.begin(), content_->shown.end());
  std::cout << cambium::detail::print_json({std::move(file)});
  return true;
}

}  // namespace examples
