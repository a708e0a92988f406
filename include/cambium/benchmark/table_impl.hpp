#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/benchmark/table.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// "merging: outcomes".
[[nodiscard]] inline std::string full_title(Table const& table) {
  return table.set.empty() ? table.title : table.set + ": " + table.title;
}

/// The words of a cell of a head, in lines of at most `width` letters where possible.
[[nodiscard]] inline std::vector<std::string> wrapped(std::string const& text, std::size_t width) {
  std::vector<std::string> lines(1);
  for (std::size_t begin = 0; begin < text.size();) {
    auto const found = text.find_first_of(" _", begin);
    auto const end = found == text.npos ? text.size() : found + 1;
    auto const word = text.substr(begin, end - begin);
    bool const has_room = lines.back().size() + word.size() - word.ends_with(' ') <= width;
    if (!has_room && !lines.back().empty()) lines.emplace_back();
    lines.back() += word;
    begin = end;
  }
  for (auto& line : lines)
    if (line.ends_with(' ')) line.pop_back();
  return lines;
}

/// Number of letters; bytes that continue a UTF-8 character do not count.
[[nodiscard]] inline std::size_t letters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

/// The head of a table in lines, each as a row.
[[nodiscard]] inline std::vector<std::vector<std::string>> head_lines(Table const& table) {
  std::vector<std::vector<std::string>> columns;
  std::size_t height = 1;
  for (std::size_t c = 0; c < table.head.size(); ++c) {
    std::size_t width = 10;
    for (auto const& row : table.rows) width = std::max(width, letters(row[c]));
    columns.push_back(wrapped(table.head[c], width));
    height = std::max(height, columns.back().size());
  }
  std::vector<std::vector<std::string>> lines(height, std::vector<std::string>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c)
    for (std::size_t i = 0; i < columns[c].size(); ++i) lines[height - columns[c].size() + i][c] = columns[c][i];
  return lines;
}

[[nodiscard]] inline std::string escape_latex(std::string_view text) {
  constexpr std::pair<char, char const*> words[] = {{'\\', "\\textbackslash{}"},
                                                    {'~', "\\textasciitilde{}"},
                                                    {'^', "\\textasciicircum{}"},
                                                    {'<', "$<$"},
                                                    {'>', "$>$"},
                                                    {'"', "''"}};
  auto const is_digit = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char const c = text[i];
    auto const* const word = std::ranges::find(words, c, &std::pair<char, char const*>::first);
    if (word != std::end(words))
      out += word->second;
    else if (std::string_view("&%$#_{}").find(c) != std::string_view::npos)
      out += std::string("\\") + c;
    else if (c == '-' && is_digit(i + 1))
      out += i > 0 && is_digit(i - 1) ? "--" : "$-$";
    else
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

}  // namespace detail

CAMBIUM_COLD std::string text_of(Table const& table) {
  auto lines = detail::head_lines(table);
  auto const head_height = lines.size();
  for (auto const& row : table.rows) lines.push_back(row);
  if (table.rows.empty()) lines.clear();
  std::vector<std::size_t> widths(table.head.size(), 0);
  for (auto& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c) {
      line[c] = detail::printable(line[c]);
      widths[c] = std::max(widths[c], detail::letters(line[c]));
    }
  std::string text = "  " + detail::printable(detail::full_title(table)) + "\n";
  for (std::size_t l = 0; l < lines.size(); ++l) {
    std::string row;
    for (std::size_t c = 0; c < lines[l].size(); ++c) {
      std::string const blanks(widths[c] - detail::letters(lines[l][c]), ' ');
      row += (c == 0 ? "    " + lines[l][c] + blanks : "  " + blanks + lines[l][c]);
    }
    row.resize(row.find_last_not_of(' ') + 1);
    text += row + "\n";
    if (l + 1 != head_height) continue;
    std::size_t all = 2 * (widths.size() - 1);
    for (auto const width : widths) all += width;
    text += "    " + std::string(all, '-') + "\n";
  }
  return table.note.empty() ? text : text + "    " + detail::printable(table.note) + "\n";
}

CAMBIUM_COLD std::string latex_of(Table const& table) {
  auto const row = [](std::vector<std::string> const& cells) {
    std::string line;
    for (auto const& cell : cells) line += (&cell == &cells.front() ? "  " : " & ") + detail::escape_latex(cell);
    return line + " \\\\\n";
  };
  std::string text = "\\begin{table}\n  \\centering\n  \\caption{" + detail::escape_latex(detail::full_title(table)) +
                     (table.note.empty() ? "" : ". " + detail::escape_latex(table.note)) + "}\n  \\begin{tabular}{l" +
                     std::string(table.head.size() - 1, 'r') + "}\n  \\toprule\n";
  for (auto const& line : detail::head_lines(table)) text += row(line);
  text += "  \\midrule\n";
  for (auto const& line : table.rows) text += row(line);
  return text + "  \\bottomrule\n  \\end{tabular}\n\\end{table}\n";
}

}  // namespace cambium::inline v0_1
