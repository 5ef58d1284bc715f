// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/number_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "core/shared/text_numbers.hpp"
#include "io/arrays/shared/sample_times.hpp"
#include "io/shared/read_file.hpp"
#include "io/text/shared/text_lines.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

/// Delimiter ' ' means any blanks.
struct Dialect {
  char delimiter;
  char decimal;
};

struct Cell {
  std::string_view text;
  std::size_t column;  // counted from 1
};

using Cells = std::vector<Cell>;

Cells cells_of(std::string_view line, char delimiter) {
  const std::string_view ends = delimiter == ' ' ? " \t\r" : std::string_view(&delimiter, 1);
  const std::string_view padding = delimiter == '\t' ? " \r" : " \t\r";
  Cells cells;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t begin = std::min(line.find_first_not_of(padding, at), line.size());
    const bool opens = begin < line.size() && line[begin] == '"';
    const std::size_t close = opens ? line.find('"', begin + 1) : std::string_view::npos;
    const bool is_quoted = close != std::string_view::npos;
    const std::size_t end =
        std::min(line.find_first_of(ends, is_quoted ? close : begin), line.size());
    std::string_view text = trimmed(line.substr(begin, end - begin));
    if (is_quoted && text.ends_with('"')) text = trimmed(text.substr(1, text.size() - 2));
    cells.push_back({text, begin + 1});
    at = end + 1;
  }
  while (!cells.empty() && cells.back().text.empty()) cells.pop_back();
  return cells;
}

std::optional<double> number_of(std::string_view text, char decimal) {
  std::string copy;
  if (decimal == ',') {
    if (text.empty() || text.find('.') != std::string_view::npos || !is_digit(text.back()))
      return std::nullopt;
    copy = text;
    std::ranges::replace(copy, ',', '.');
    text = copy;
  }
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  double number = 0.0;
  const auto result = std::from_chars(text.data(), end, number);
  if (result.ptr != end || text.empty()) return std::nullopt;
  if (result.ec == std::errc::result_out_of_range) return INFINITY;
  return result.ec == std::errc() ? std::optional(number) : std::nullopt;
}

/// [begin, end) in each row.
struct Columns {
  std::size_t begin = 0, end = 0;
  std::size_t count() const { return end - begin; }
  auto operator<=>(const Columns&) const = default;
};

/// Returns the columns of a line of numbers, optionally after empty cells.
std::optional<Columns> columns_of_row(const Cells& cells, char decimal) {
  Columns columns{0, cells.size()};
  while (columns.begin < columns.end && cells[columns.begin].text.empty()) ++columns.begin;
  for (std::size_t i = columns.begin; i < columns.end; ++i)
    if (!number_of(cells[i].text, decimal)) return std::nullopt;
  return columns.count() > 0 ? std::optional(columns) : std::nullopt;
}

Columns most_frequent_columns(const std::vector<TextLine>& lines, Dialect dialect) {
  struct Count {
    std::size_t lines = 0, first = 0;
  };
  std::map<Columns, Count> counts;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (const auto columns =
            columns_of_row(cells_of(lines[i].text, dialect.delimiter), dialect.decimal))
      if (Count& count = counts[*columns]; ++count.lines == 1) count.first = i;
  const auto rank = [](const auto& entry) {
    return std::tuple(entry.second.lines, -static_cast<std::ptrdiff_t>(entry.second.first));
  };
  const auto best = std::ranges::max_element(counts, {}, rank);
  return best == counts.end() ? Columns{} : best->first;
}

/// Cells to the left may contain a header that begins with text.
std::optional<std::vector<double>> row_of(const Cells& cells, Columns columns, char decimal) {
  if (cells.size() != columns.end || columns.count() == 0) return std::nullopt;
  const auto first = std::ranges::find_if(cells, [](const Cell& c) { return !c.text.empty(); });
  if (first < cells.begin() + static_cast<std::ptrdiff_t>(columns.begin) &&
      number_of(first->text, decimal))
    return std::nullopt;
  std::vector<double> numbers;
  for (std::size_t i = columns.begin; i < columns.end; ++i) {
    const std::optional<double> number = number_of(cells[i].text, decimal);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

/// A text in one dialect, up to the first line that is not a row.
struct Reading {
  Dialect dialect;
  Columns columns;
  std::size_t first = 0;
  std::size_t rows = 0;
  bool complete = false;

  Cells cells(const TextLine& line) const { return cells_of(line.text, dialect.delimiter); }
  std::optional<std::vector<double>> row(const TextLine& line) const {
    return row_of(cells(line), columns, dialect.decimal);
  }
};

Reading reading_of(const std::vector<TextLine>& lines, Dialect dialect) {
  Reading reading{dialect, most_frequent_columns(lines, dialect)};
  const auto has_columns = [&](const TextLine& line) {
    return columns_of_row(reading.cells(line), dialect.decimal) == reading.columns;
  };
  const auto first = std::ranges::find_if(lines, has_columns);
  reading.first = static_cast<std::size_t>(first - lines.begin());
  // The first rows may be next to a header.
  while (reading.first > 0 && reading.row(lines[reading.first - 1])) --reading.first;
  std::size_t end = reading.first;
  while (end < lines.size() && reading.row(lines[end])) ++end;
  reading.rows = end - reading.first;
  reading.complete = reading.rows > 0 && end == lines.size();
  return reading;
}

std::string place_of(std::string_view file, const TextLine& line, std::size_t column) {
  return fmt::format("{}:{}:{}", file, line.number, column);
}

constexpr std::string_view no_rows = "found no row of numbers; expected at least one";

[[noreturn]] void refuse_line(const TextLine& line, const Reading& reading, std::size_t first_line,
                              std::string_view file) {
  const Cells cells = reading.cells(line);
  for (std::size_t i = reading.columns.begin; i < cells.size(); ++i)
    if (!number_of(cells[i].text, reading.dialect.decimal))
      throw IoError(
          place_of(file, line, cells[i].column),
          fmt::format("found '{}' in column {}; expected a finite number", cells[i].text, i + 1));
  throw IoError(place_of(file, line, 1),
                fmt::format("found {} columns; expected {} as in line {}", cells.size(),
                            reading.columns.end, first_line));
}

/// Returns true if "12,5" is two columns, because the first numbers are integers with equal steps.
bool first_column_counts(const std::vector<TextLine>& lines, const Reading& reading) {
  double last = 0.0, step = 0.0;
  for (std::size_t r = 0; r < reading.rows; ++r) {
    const double value = reading.row(lines[reading.first + r])->front();
    if (value != std::round(value)) return false;
    if (r == 1) step = value - last;
    if (r >= 1 && (value - last != step || step <= 0.0)) return false;
    last = value;
  }
  return reading.rows >= 3;
}

/// Digits after a zero, "05", can only follow a decimal comma.
bool is_fraction(std::string_view text) {
  return text.size() > 1 && text[0] == '0' && std::ranges::all_of(text, is_digit);
}

bool second_column_is_fraction(const std::vector<TextLine>& lines, const Reading& reading) {
  for (std::size_t r = 0; r < reading.rows && reading.columns.count() > 1; ++r) {
    const Cells cells = reading.cells(lines[reading.first + r]);
    const std::string_view text = cells[reading.columns.begin + 1].text;
    if (is_fraction(text)) return true;
  }
  return false;
}

/// Commas can be delimiters or decimal marks.
Reading settle_commas(const std::vector<TextLine>& lines, const Reading& delimiters,
                      const Reading& decimals, std::string_view file) {
  const std::size_t names =
      delimiters.first == 0 ? 0 : delimiters.cells(lines[delimiters.first - 1]).size();
  if (names == delimiters.columns.count() && names > 1) return delimiters;
  if (names == 1 && decimals.columns.count() == 1) return decimals;
  if (second_column_is_fraction(lines, delimiters)) return decimals;
  if (names == 0 && first_column_counts(lines, delimiters)) return delimiters;
  const TextLine& line = lines[delimiters.first];
  throw IoError(place_of(file, line, 1),
                fmt::format("found '{}', which can be {} columns or numbers with decimal commas; "
                            "expected a header with as many names as columns, or --decimal point "
                            "or comma, if the command has this option",
                            trimmed(line.text), delimiters.columns.count()));
}

std::vector<Reading> readings_of(const std::vector<TextLine>& lines, std::string_view text,
                                 DecimalMark decimal) {
  const auto has = [&](char c) { return text.find(c) != std::string_view::npos; };
  std::vector<Reading> readings;
  for (const char mark : {'.', ','}) {
    if (decimal != DecimalMark::automatic && (decimal == DecimalMark::comma) != (mark == ','))
      continue;
    if (decimal == DecimalMark::automatic && mark == ',' && !has(',')) continue;
    for (const char delimiter : {'\t', ';', ',', ' '}) {
      if (delimiter != ' ' && !has(delimiter)) continue;
      if (delimiter == ',' && mark == ',' && !has('"')) continue;  // ambiguous
      readings.push_back(reading_of(lines, {delimiter, mark}));
    }
  }
  return readings;
}

Reading chosen_reading(const std::vector<TextLine>& lines, std::string_view text,
                       std::string_view file, const NumberTableOptions& options) {
  std::vector<Reading> readings = readings_of(lines, text, options.decimal);
  const auto rank = [](const Reading& r) {
    return std::tuple(r.rows, -static_cast<std::ptrdiff_t>(r.first), r.columns.count());
  };
  const Reading best = *std::ranges::max_element(readings, {}, rank);
  if (best.rows == 0) throw IoError(file, no_rows);
  // Rows of another dialect cannot be a header or follow the table.
  std::erase_if(readings, [&](const Reading& r) {
    return !r.complete || r.rows < best.rows || r.first > best.first;
  });
  if (readings.empty())
    refuse_line(lines[best.first + best.rows], best, lines[best.first].number, file);
  const auto fits = [&](const Reading& r) {
    return r.columns.count() >= options.min_columns && r.columns.count() <= options.max_columns;
  };
  if (std::ranges::any_of(readings, fits)) std::erase_if(readings, std::not_fn(fits));
  // Readings with more columns are equivalent, except for the two meanings of commas.
  const Reading* point = nullptr;
  const Reading* comma = nullptr;
  for (const Reading& reading : readings) {
    const Reading*& slot = reading.dialect.decimal == '.' ? point : comma;
    if (slot == nullptr || reading.columns.count() > slot->columns.count()) slot = &reading;
  }
  if (point == nullptr) return *comma;
  if (comma == nullptr || point->dialect.delimiter != ',' ||
      point->columns.count() == comma->columns.count())
    return *point;
  return settle_commas(lines, *point, *comma, file);
}

/// Rejects lines above the first row that were intended as rows: only numbers, or a number followed
/// by as many cells as in a row.
void check_header(const std::vector<TextLine>& lines, const Reading& reading,
                  std::string_view file) {
  for (std::size_t i = 0; i < reading.first; ++i) {
    const Cells cells = reading.cells(lines[i]);
    const auto is_number = [&](const Cell& cell) {
      return number_of(cell.text, reading.dialect.decimal).has_value();
    };
    const auto numbers = static_cast<std::size_t>(std::ranges::count_if(cells, is_number));
    const bool is_damaged_row = i + 1 == reading.first && cells.size() == reading.columns.end &&
                                (is_number(cells.front()) || 2 * numbers > cells.size());
    if (numbers == cells.size() || is_damaged_row)
      refuse_line(lines[i], reading, lines[reading.first].number, file);
  }
}

/// Rejects numbers with decimal commas, separated by commas: "2900,0000,2000,0756".
void refuse_split_fractions(const std::vector<TextLine>& lines, const Reading& reading,
                            std::string_view file) {
  if (reading.dialect.delimiter != ',' || reading.dialect.decimal != '.') return;
  const TextLine* found = nullptr;
  std::size_t column = 0;
  for (std::size_t r = 0; r < reading.rows; ++r) {
    const TextLine& line = lines[reading.first + r];
    if (line.text.find('.') != std::string_view::npos) return;
    const Cells cells = reading.cells(line);
    for (std::size_t i = reading.columns.begin + 1; i < cells.size() && found == nullptr; ++i)
      if (is_fraction(cells[i].text)) {
        found = &line;
        column = cells[i].column;
      }
  }
  if (found != nullptr)
    throw IoError(place_of(file, *found, column),
                  fmt::format("found '{}', which has both decimal commas and commas between "
                              "columns; expected semicolons or tabs between columns",
                              trimmed(found->text)));
}

/// Names are text, empty, or channel numbers after the first.
std::vector<std::string> names_in(const Cells& cells, const Reading& reading) {
  const Columns columns = reading.columns;
  if (cells.size() < columns.end) return {};
  if (reading.dialect.delimiter == ' ' && cells.size() != columns.end) return {};
  std::vector<std::string> names;
  for (std::size_t i = columns.begin; i < columns.end; ++i) {
    const std::string_view text = cells[i].text;
    const bool is_channel = i > columns.begin && std::ranges::all_of(text, is_digit);
    if (!is_channel && number_of(text, reading.dialect.decimal)) return {};
    names.emplace_back(text);
  }
  return names;
}

void read_header(NumberTable& table, const std::vector<TextLine>& lines, const Reading& reading,
                 std::string_view file) {
  if (reading.first >= 1) table.names = names_in(reading.cells(lines[reading.first - 1]), reading);
  if (reading.first >= 2 && !table.names.empty())
    table.upper_names = names_in(reading.cells(lines[reading.first - 2]), reading);
  const auto keep = [&](const Cells& cells, std::size_t count) {
    std::vector<std::string>& kept = table.header.emplace_back();
    for (std::size_t i = 0; i < std::min(count, cells.size()); ++i)
      kept.emplace_back(cells[i].text);
  };
  for (std::size_t i = 0; i < reading.first; ++i) {
    const Cells cells = reading.cells(lines[i]);
    keep(cells, cells.size());
  }
  if (reading.columns.begin > 0)
    for (std::size_t r = 0; r < reading.rows; ++r)
      if (const Cells cells = reading.cells(lines[reading.first + r]); !cells[0].text.empty())
        keep(cells, reading.columns.begin);

  const std::size_t skipped =
      reading.first - (table.names.empty() ? 0 : 1) - (table.upper_names.empty() ? 0 : 1);
  if (skipped > 0)
    table.notes.push_back(fmt::format("{}: {} line{} of text before the numbers {} skipped", file,
                                      skipped, skipped == 1 ? "" : "s",
                                      skipped == 1 ? "was" : "were"));
  if (reading.dialect.decimal == ',')
    table.notes.push_back(fmt::format("{}: commas were read as decimal marks", file));
  if (table.header.size() > reading.first)
    table.notes.push_back(fmt::format("{}: its numbers begin in column {}, next to a header", file,
                                      table.first_column));
}

std::string lower_cased(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), lower_case);
  return lower;
}

}  // namespace

bool is_measured(double number) {
  constexpr double least_code = 9.89e37;  // below 9.9e37, to allow for rounding
  return std::abs(number) < least_code;
}

NumberTable parse_number_table(std::string_view text, std::string_view file,
                               const NumberTableOptions& options) {
  std::vector<TextLine> lines = content_lines(text);
  std::erase_if(lines, [](const TextLine& line) {
    return line.text.find_first_not_of(" \t\r,;\"") == std::string_view::npos;
  });
  if (lines.empty()) throw IoError(file, no_rows);
  const Reading reading = chosen_reading(lines, text, file, options);
  check_header(lines, reading, file);
  refuse_split_fractions(lines, reading, file);
  NumberTable table;
  table.first_column = reading.columns.begin + 1;
  table.values.resize(static_cast<Eigen::Index>(reading.rows),
                      static_cast<Eigen::Index>(reading.columns.count()));
  for (std::size_t r = 0; r < reading.rows; ++r) {
    const TextLine& line = lines[reading.first + r];
    const std::vector<double> numbers = *reading.row(line);
    for (std::size_t c = 0; c < numbers.size(); ++c) {
      if (!is_measured(numbers[c])) {
        const Cell cell = reading.cells(line)[reading.columns.begin + c];
        throw IoError(
            place_of(file, line, cell.column),
            fmt::format("found '{}' in column {}; expected a finite number{}", cell.text,
                        table.first_column + c,
                        std::isfinite(numbers[c])
                            ? " (SCPI writes 9.9E+37 for infinity and 9.91E+37 for no number): "
                              "repeat the measurement, or remove the line"
                            : ""));
      }
      table.values(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = numbers[c];
    }
    table.lines.push_back(line.number);
  }
  read_header(table, lines, reading, file);
  return table;
}

NumberTable read_number_table(const std::filesystem::path& path,
                              const NumberTableOptions& options) {
  return parse_number_table(read_text_file(path), path.string(), options);
}

NumberTable read_number_column(const std::filesystem::path& path, std::string_view content,
                               DecimalMark decimal) {
  NumberTable table = read_number_table(path, {.decimal = decimal, .max_columns = 1});
  if (table.values.cols() == 2 && counts_samples(table, 0)) {
    table.notes.push_back(
        fmt::format("{}: its first column, a counter, was not read", path.string()));
    table.values = table.values.rightCols(1).eval();
  }
  if (table.values.cols() != 1)
    throw IoError(path.string(), fmt::format("found {}; expected one column, {}",
                                             table.describe_columns(), content));
  return table;
}

bool is_number_table(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 4> extensions = {".csv", ".txt", ".tsv", ".dat"};
  return std::ranges::find(extensions, lower_extension(path)) != extensions.end();
}

std::string NumberTable::describe_columns() const {
  const bool are_units = std::set(names.begin(), names.end()).size() < names.size();
  std::vector<std::string> shown = names;
  if (are_units && !upper_names.empty())
    for (std::size_t i = 0; i < shown.size(); ++i)
      shown[i] = fmt::format("{} {}", upper_names[i], names[i]);
  const std::string list = shown.empty() ? "" : fmt::format(" ({})", fmt::join(shown, ", "));
  return fmt::format("{} columns{}", values.cols(), list);
}

Eigen::Index NumberTable::column_of(std::string_view name_or_number, std::string_view file) const {
  const auto count = static_cast<std::size_t>(values.cols());
  const std::string wanted = lower_cased(name_or_number);
  const auto columns_where = [&](const auto& is_wanted) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < count; ++i)
      if ((!names.empty() && is_wanted(names[i])) ||
          (!upper_names.empty() && is_wanted(upper_names[i])))
        found.push_back(i);
    return found;
  };
  const auto begins_with_it = [&](const std::string& name) {
    return name.size() > wanted.size() && lower_cased(name).starts_with(wanted) &&
           !is_digit(name[wanted.size()]);
  };
  auto found = columns_where([&](const std::string& name) { return name == name_or_number; });
  if (found.empty())
    found = columns_where([&](const std::string& name) { return lower_cased(name) == wanted; });
  if (const std::optional<double> number = number_in(wanted); found.empty() && number) {
    const double first = static_cast<double>(first_column);
    if (*number == std::floor(*number) && *number >= first &&
        *number < first + static_cast<double>(count))
      found = {static_cast<std::size_t>(*number) - first_column};
  }
  if (found.empty() && !wanted.empty() && !is_digit(wanted[0]))
    found = columns_where(begins_with_it);
  if (found.size() == 1) return static_cast<Eigen::Index>(found.front());
  throw IoError(file, fmt::format("found {} column {} among {}; expected one of the names, or {} "
                                  "to {}",
                                  found.empty() ? "no" : "more than one", name_or_number,
                                  describe_columns(), first_column, first_column + count - 1));
}

}  // namespace tofsmith
