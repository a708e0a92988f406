#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"

namespace examples {

/// Reads all of `text` as a finite number; false where it is none.
template <class Number>
[[nodiscard]] bool read_number(std::string_view text, Number& value) {
  auto const [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  return problem == std::errc{} && end == text.data() + text.size() && value - value == Number{};
}

/// A table of comma-separated values, whose first line may name its columns. No quotes: a cell ends at the comma.
class CsvTable {
 public:
  /// Reads the columns `names` of `file`: by these names where the first line has them (in any order, among others),
  /// else the first ones. Throws `cambium::Error` with file and line.
  CsvTable(std::string file, std::vector<std::string> names) : file_(std::move(file)), names_(std::move(names)) {
    std::ifstream in(file_);
    if (!in) fail(0, "it cannot be opened", "check the path");
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (line.empty()) continue;
      if (rows_.empty() && places_.empty() && take_heading(line)) continue;
      add_row(number, line);
    }
    if (in.bad() || rows_.empty()) fail(0, "it has no row that could be read", "give lines of " + joined());
  }

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] std::string const& word(std::size_t row, std::size_t column) const { return rows_[row].cells[column]; }

  /// The cell as a finite number. Throws `cambium::Error` where it is none.
  template <class Number>
  [[nodiscard]] Number number(std::size_t row, std::size_t column) const {
    Number value{};
    if (read_number(word(row, column), value)) return value;
    fail(rows_[row].line, names_[column] + " is '" + word(row, column) + "', which is no finite number of its kind",
         "write it like 12.5, the lane like -1");
  }

  /// Throws `cambium::Error` that names the row's line.
  [[noreturn]] void fail_at(std::size_t row, std::string const& what, std::string const& remedy) const {
    fail(rows_[row].line, what, remedy);
  }

 private:
  struct Row {
    int line;
    std::vector<std::string> cells;
  };

  [[nodiscard]] static std::vector<std::string> split(std::string_view line) {
    std::vector<std::string> cells;
    for (std::size_t begin = 0; begin <= line.size();) {
      std::size_t const end = std::min(line.find(',', begin), line.size());
      std::string_view cell = line.substr(begin, end - begin);
      while (!cell.empty() && cell.front() == ' ') cell.remove_prefix(1);
      while (!cell.empty() && cell.back() == ' ') cell.remove_suffix(1);
      cells.emplace_back(cell);
      begin = end + 1;
    }
    return cells;
  }

  bool take_heading(std::string const& line) {
    std::vector<std::string> const cells = split(line);
    std::vector<std::size_t> places;
    for (std::string const& name : names_)
      for (std::size_t i = 0; i < cells.size(); ++i)
        if (cells[i] == name) {
          places.push_back(i);
          break;
        }
    if (places.size() != names_.size()) return false;
    places_ = places;
    return true;
  }

  void add_row(int line, std::string const& text) {
    std::vector<std::string> const cells = split(text);
    Row row{line, {}};
    for (std::size_t i = 0; i < names_.size(); ++i) {
      std::size_t const place = places_.empty() ? i : places_[i];
      if (place >= cells.size()) fail(line, "there is no " + names_[i] + " in it", "give lines of " + joined());
      row.cells.push_back(cells[place]);
    }
    rows_.push_back(std::move(row));
  }

  [[nodiscard]] std::string joined() const {
    std::string text;
    for (std::string const& name : names_) text += (text.empty() ? "" : ",") + name;
    return text;
  }

  [[noreturn]] void fail(int line, std::string const& what, std::string const& remedy) const {
    throw cambium::Error(line > 0 ? file_ + ":" + std::to_string(line) : file_, what, remedy);
  }

  std::string file_;
  std::vector<std::string> names_;
  std::vector<std::size_t> places_;
  std::vector<Row> rows_;
};

/// The 17 digits that read back as the same number.
[[nodiscard]] inline std::string digits(double value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 17).ptr};
}

}  // namespace examples
