#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <type_traits>
#include <vector>

#include <CLI/CLI.hpp>

#include "cambium/core/error.hpp"
#include "cambium/core/text.hpp"

#include "mistakes.hpp"
#include "part_file.hpp"
#include "version.hpp"

namespace examples {

/// Accepts whole numbers from `low` to `high`. (CLI11's own range check accepts numbers that overflow the integer.)
[[nodiscard]] inline CLI::Validator whole_number(std::uint64_t low, std::uint64_t high) {
  auto const check = [low, high](std::string const& word) -> std::string {
    auto const value = cambium::detail::parse_number<std::uint64_t>(word);
    if (value && *value >= low && *value <= high) return {};
    return "needs a whole number from " + std::to_string(low) + " to " + std::to_string(high) + ", not '" + word + "'";
  };
  return CLI::Validator(check, "");
}

/// Accepts numbers from `low` to `high`.
[[nodiscard]] inline CLI::Validator number(double low, double high) {
  auto const check = [low, high](std::string const& word) -> std::string {
    auto const value = cambium::detail::parse_number<double>(word);
    if (value && *value >= low && *value <= high) return {};
    return "needs a number from " + cambium::detail::rounded_text(low) + " to " + cambium::detail::rounded_text(high) +
           ", not '" + word + "'";
  };
  return CLI::Validator(check, "");
}

/// An option that takes a comma-separated list of values that `each` accepts. Duplicates are dropped.
template <class Number>
CLI::Option* add_list(CLI::App& program, std::string const& name, std::vector<Number>& target, CLI::Validator each,
                      std::string const& sentence) {
  auto const words = [](std::string const& list) {
    std::vector<std::string> result(1);
    for (char const c : list) {
      if (c == ',')
        result.emplace_back();
      else
        result.back() += c;
    }
    return result;
  };
  auto const check = [words, each](std::string const& list) {
    std::string problem;
    for (auto const& word : words(list))
      if (problem.empty()) problem = each(word);
    return problem;
  };
  auto const take = [words, &target](std::string const& list) {
    target.clear();
    for (auto const& word : words(list))
      if (auto const value = *cambium::detail::parse_number<Number>(word);
          std::find(target.begin(), target.end(), value) == target.end())
        target.push_back(value);
  };
  std::string usual;
  for (auto const value : target) usual += (usual.empty() ? "" : ",") + cambium::detail::rounded_text(double(value));
  return program.add_option_function<std::string>(name, take, sentence)
      ->check(CLI::Validator(check, ""))
      ->default_str(usual);
}

/// Accepts any text except an empty one.
[[nodiscard]] inline CLI::Validator not_empty() {
  return CLI::Validator(
      [](std::string const& word) {
        return word.empty() ? std::string("needs a name, but got an empty text") : std::string();
      },
      "");
}

/// Flushes the standard output. Returns 0, or 2 with a line on the error stream if the output could not be written.
[[nodiscard]] inline int finish_output(std::string const& program) {
  if (std::fflush(stdout) == 0 && std::cout.flush()) return 0;
  std::cerr << program << ": the standard output cannot be written\n";
  return 2;
}

/// The program's long options, as `--name`.
[[nodiscard]] inline std::vector<std::string> long_options(CLI::App const& program) {
  std::vector<std::string> names;
  for (auto const* const option : program.get_options())
    for (auto const& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// Parses the command line, then runs `body`, whose return value, if any, is the exit code. An exception becomes one
/// line on the error stream and exit code 2.
template <class Body>
int run_program(CLI::App& program, int argc, char** argv, Body const& body) {
  auto const refuse = [&program](std::string const& what) {
    std::cerr << program.get_name() << ": " << what << "\n";
    return 2;
  };
  program.set_version_flag("--version", program.get_name() + " of cambium " + version(), "print the version and exit");
  try {
    program.parse(argc, argv);
    int code = 0;
    if constexpr (std::is_void_v<decltype(body())>)
      body();
    else
      code = body();
    int const written = finish_output(program.get_name());
    return written != 0 ? written : code;
  } catch (CLI::CallForHelp const&) {
    std::cout << program.help();
    return finish_output(program.get_name());
  } catch (CLI::CallForVersion const& text) {
    std::cout << text.what() << "\n";
    return finish_output(program.get_name());
  } catch (CLI::ExtrasError const&) {
    return refuse(unknown_words(program.remaining(), long_options(program)));
  } catch (CLI::ArgumentMismatch const& problem) {
    std::string const text = problem.what();
    // The words of CLI11 before 2.7, and since.
    bool const is_repeated = text.find("At Most") != text.npos || text.find("At most") != text.npos;
    return refuse(text.substr(0, text.find(':')) +
                  (is_repeated ? ": given more than once" : ": not as many values as it takes") +
                  " (--help lists the options)");
  } catch (CLI::ParseError const& problem) {
    return refuse(problem.what() + std::string(" (--help lists the options)"));
  } catch (std::exception const& problem) {
    return refuse(without_functions(problem.what()));
  }
}

}  // namespace examples
