#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace examples {

/// A wrong command line: one line for the user.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Command line options of an example: `--name VALUE` and `--name=VALUE`, each described once.
class Options {
 public:
  Options(std::string program, std::string purpose) : program_(std::move(program)), purpose_(std::move(purpose)) {}

  void text(std::string name, std::string value_name, std::string& target, std::string sentence) {
    std::string shown = target.empty() ? "" : " (default " + target + ")";
    entries_.push_back({std::move(name), std::move(value_name), std::move(sentence) + shown, [&target](std::string const& v) {
                          if (v.empty()) throw UsageError("needs a value");
                          target = v;
                        }});
  }

  /// A whole number between `low` and `high`.
  void number(std::string name, std::string value_name, std::uint64_t& target, std::uint64_t low, std::uint64_t high, std::string sentence) {
    std::string const shown = " (default " + std::to_string(target) + ")";
    entries_.push_back({std::move(name), std::move(value_name), std::move(sentence) + shown, [&target, low, high](std::string const& v) {
                          std::uint64_t value = 0;
                          auto const [end, error] = std::from_chars(v.data(), v.data() + v.size(), value);
                          if (error != std::errc{} || end != v.data() + v.size() || value < low || value > high)
                            throw UsageError("needs a whole number from " + std::to_string(low) + " to " + std::to_string(high) + ", not '" + v + "'");
                          target = value;
                        }});
  }

  /// Reads the command line. False: the help was asked for and printed. Throws `UsageError`.
  [[nodiscard]] bool parse(int argc, char const* const* argv) const {
    for (int i = 1; i < argc; ++i) {
      std::string const word = argv[i];
      if (word == "--help" || word == "-h") {
        print_help();
        return false;
      }
      auto const equals = word.find('=');
      std::string const name = word.substr(0, equals);
      auto const& entry = find(name);
      if (equals == std::string::npos && i + 1 >= argc) throw UsageError(name + " needs a value");
      std::string const value = equals == std::string::npos ? argv[++i] : word.substr(equals + 1);
      try {
        entry.set(value);
      } catch (UsageError const& e) {
        throw UsageError(name + " " + e.what());
      }
    }
    return true;
  }

 private:
  struct Entry {
    std::string name, value_name, sentence;
    std::function<void(std::string const&)> set;
  };

  [[nodiscard]] Entry const& find(std::string const& name) const {
    for (auto const& entry : entries_)
      if (entry.name == name) return entry;
    throw UsageError("unknown option '" + name + "'; --help lists those there are");
  }

  void print_help() const {
    std::cout << program_ << ": " << purpose_ << "\n\nOptions:\n";
    for (auto const& entry : entries_) {
      std::string head = "  " + entry.name + " " + entry.value_name;
      head.resize(std::max<std::size_t>(head.size() + 2, 24), ' ');
      std::cout << head << entry.sentence << "\n";
    }
    std::cout << "  --help                this text\n";
  }

  std::string program_, purpose_;
  std::vector<Entry> entries_;
};

/// Runs `body` and turns what it throws into one line on the error stream and exit code 2.
template <class Body>
int run_program(std::string const& program, Body const& body) {
  try {
    return body();
  } catch (std::exception const& e) {
    std::cerr << program << ": " << e.what() << "\n";
    return 2;
  }
}

}  // namespace examples
