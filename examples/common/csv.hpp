#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/text.hpp"

namespace examples {

/// `text` as a CSV cell that `CsvTable` reads back, quoted if necessary (RFC 4180).
[[nodiscard]] inline std::string csv_cell(std::string const& text) {
  bool const has_blank_end = !text.empty() && (text.front() == ' ' || text.back() == ' ');
  if (!has_blank_end && text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string cell = "\"";
  for (char const c : text) cell += c == '"' ? "\"\"" : std::string(1, c);
  return cell + '"';
}

/// A table of comma-separated values. The first line may name the columns. Cells may be quoted, but must not contain
/// line breaks.
class CsvTable {
 public:
  /// Reads the columns `names` of `file`. If the first line contains these names, in any order and among others, they
  /// select the columns; else the first columns count. Throws `cambium::Error` with file and line.
  CsvTable(std::string file, std::vector<std::string> names) : file_(std::move(file)), names_(std::move(names)) {
    std::ifstream in(file_);
    if (!in) fail(0, "it cannot be opened", "check the path");
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (line.empty()) continue;
      std::vector<std::string> const cells = split(number, line);
      if (rows_.empty() && places_.empty() && take_heading(number, cells)) continue;
      add_row(number, cells);
    }
    if (in.bad() || rows_.empty()) fail(0, "it has no row that could be read", "give lines of " + joined());
  }

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] std::string const& word(std::size_t row, std::size_t column) const { return rows_[row].cells[column]; }

  /// The cell as a finite number. Throws `cambium::Error` if it is not one.
  template <class Number>
  [[nodiscard]] Number number(std::size_t row, std::size_t column) const {
    if (auto const value = cambium::detail::parse_number<Number>(word(row, column))) return *value;
    fail(rows_[row].line, names_[column] + " is '" + word(row, column) + "', which is not a valid finite number",
         "write numbers like 12.5 and lanes like -1");
  }

  /// Throws `cambium::Error` with the file and line of the row.
  [[noreturn]] void fail_at(std::size_t row, std::string const& what, std::string const& remedy) const {
    fail(rows_[row].line, what, remedy);
  }

 private:
  struct Row {
    int line;
    std::vector<std::string> cells;
  };

  /// The end of the cell that begins at `begin`: its comma or the end of the line; npos if a quote is not closed.
  [[nodiscard]] static std::size_t end_of_cell(std::string_view line, std::size_t begin) {
    std::size_t const first = line.find_first_not_of(' ', begin);
    if (first == line.npos || line[first] != '"') return std::min(line.find(',', begin), line.size());
    bool is_open = true;
    for (std::size_t i = first + 1; i < line.size(); ++i) {
      if (line[i] == '"') is_open = !is_open;
      if (line[i] == ',' && !is_open) return i;
    }
    return is_open ? line.npos : line.size();
  }

  /// The content of a cell, without surrounding blanks and quotes.
  [[nodiscard]] static std::string content(std::string_view cell) {
    cell = cambium::detail::trimmed(cell, " ");
    if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return std::string(cell);
    std::string text(cell.substr(1, cell.size() - 2));
    for (std::size_t at = text.find("\"\""); at != text.npos; at = text.find("\"\"", at + 1)) text.erase(at, 1);
    return text;
  }

  [[nodiscard]] std::vector<std::string> split(int number, std::string_view line) const {
    std::vector<std::string> cells;
    for (std::size_t begin = 0; begin <= line.size();) {
      std::size_t const end = end_of_cell(line, begin);
      if (end == line.npos) fail(number, "a quote in it is not closed", "close it on the same line");
      cells.push_back(content(line.substr(begin, end - begin)));
      begin = end + 1;
    }
    return cells;
  }

  bool take_heading(int line, std::vector<std::string> const& cells) {
    std::vector<std::size_t> places;
    std::string missing;
    for (std::string const& name : names_) {
      auto const found = std::find(cells.begin(), cells.end(), name);
      if (found == cells.end()) missing += (missing.empty() ? "" : ",") + name;
      places.push_back(static_cast<std::size_t>(found - cells.begin()));
    }
    auto const is_number = [](std::string const& cell) { return bool(cambium::detail::parse_number<double>(cell)); };
    if (!missing.empty() && std::none_of(cells.begin(), cells.end(), is_number))
      fail(line, "the first line names none of " + missing, "give the columns " + joined() + ", with or without names");
    if (missing.empty()) places_ = places;
    return missing.empty();
  }

  void add_row(int line, std::vector<std::string> const& cells) {
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

/// `value` with 17 digits, which read back as the same number.
[[nodiscard]] inline std::string digits(double value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 17).ptr};
}

}  // namespace examples
