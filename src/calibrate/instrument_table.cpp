// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/instrument_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <tuple>

#include "core/shared/enum_words.hpp"
#include "core/shared/text_numbers.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

struct Line {
  std::size_t number;  // counted from 1
  std::string_view text;
};

/// One way of reading a file; delimiter ' ' stands for any blanks.
struct Dialect {
  char delimiter;
  char decimal;
};

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::vector<Line> lines_of(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // byte order mark
  std::vector<Line> lines;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    const std::string_view content = trimmed(line);
    if (!content.empty() && !content.starts_with('#')) lines.push_back({number, line});
  }
  return lines;
}

/// Fields of a line; empty ones at both ends, as spreadsheets leave them, do not count.
std::vector<std::string_view> split(std::string_view line, char delimiter) {
  std::vector<std::string_view> fields;
  if (delimiter == ' ') {
    for (std::size_t at = line.find_first_not_of(blanks); at < line.size();) {
      const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
      fields.push_back(line.substr(at, end - at));
      at = line.find_first_not_of(blanks, end);
    }
    return fields;
  }
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(delimiter, at), line.size());
    std::string_view field = trimmed(line.substr(at, end - at));
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
      field = field.substr(1, field.size() - 2);
    fields.push_back(field);
    at = end + 1;
  }
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
  while (!fields.empty() && fields.front().empty()) fields.erase(fields.begin());
  return fields;
}

/// The number in a field, which may be NaN or infinite.
std::optional<double> number_in(std::string_view field, char decimal) {
  std::string text(field);
  if (decimal == ',') {
    if (text.find('.') != std::string::npos) return std::nullopt;
    std::ranges::replace(text, ',', '.');
  }
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* const end = text.data() + text.size();
  double number = 0.0;
  const auto result = std::from_chars(begin, end, number);
  if (result.ec == std::errc::result_out_of_range && result.ptr == end) return INFINITY;
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return number;
}

std::optional<std::vector<double>> numbers_in(std::string_view line, Dialect dialect) {
  std::vector<double> numbers;
  for (const std::string_view field : split(line, dialect.delimiter)) {
    const std::optional<double> number = number_in(field, dialect.decimal);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  if (numbers.empty()) return std::nullopt;
  return numbers;
}

/// A file as one dialect reads it, up to the first line that does not fit.
struct Reading {
  Dialect dialect;
  std::size_t first = 0;  // line of the first row
  std::size_t rows = 0;
  std::size_t columns = 0;
  bool complete = false;
};

Reading reading_of(const std::vector<Line>& lines, Dialect dialect) {
  Reading reading{dialect};
  while (reading.first < lines.size() && !numbers_in(lines[reading.first].text, dialect))
    ++reading.first;
  for (std::size_t i = reading.first; i < lines.size(); ++i) {
    const auto numbers = numbers_in(lines[i].text, dialect);
    if (!numbers) return reading;
    if (reading.rows == 0) reading.columns = numbers->size();
    if (numbers->size() != reading.columns) return reading;
    ++reading.rows;
  }
  reading.complete = reading.rows > 0;
  return reading;
}

/// Whether lines such as "12,5" are two columns: their first numbers are whole and rise by equal
/// steps, as those of bins do. Nothing if that is unknown.
bool first_column_counts(const std::vector<Line>& lines, const Reading& reading) {
  double last = 0.0, step = 0.0;
  for (std::size_t r = 0; r < reading.rows; ++r) {
    const double value = (*numbers_in(lines[reading.first + r].text, reading.dialect))[0];
    if (value != std::round(value)) return false;
    if (r == 1) step = value - last;
    if (r >= 1 && (value - last != step || step <= 0.0)) return false;
    last = value;
  }
  return reading.rows >= 3;
}

std::size_t header_fields(const std::vector<Line>& lines, const Reading& reading, char delimiter) {
  return reading.first == 0 ? 0 : split(lines[reading.first - 1].text, delimiter).size();
}

/// Commas as delimiters or as decimal marks, where both can be read.
Reading settle_commas(const std::vector<Line>& lines, const Reading& delimiters,
                      const Reading& decimals, std::string_view file) {
  const std::size_t names = header_fields(lines, delimiters, ',');
  if (names == delimiters.columns && names > 1) return delimiters;
  if (names == 1 && decimals.columns == 1) return decimals;
  if (names == 0 && first_column_counts(lines, delimiters)) return delimiters;
  const Line& line = lines[delimiters.first];
  throw IoError(fmt::format("{}:{}", file, line.number),
                fmt::format("found '{}', which can be {} columns or numbers with decimal commas; "
                            "expected a header with as many names as columns, or --decimal point "
                            "or comma",
                            trimmed(line.text), delimiters.columns));
}

/// What is wrong with the line at which the best reading ended.
[[noreturn]] void refuse(const std::vector<Line>& lines, const Reading& best,
                         std::string_view file) {
  if (best.rows == 0) throw IoError(file, "found no row of numbers; expected at least one");
  const Line& line = lines[best.first + best.rows];
  const auto fields = split(line.text, best.dialect.delimiter);
  const std::string place = fmt::format("{}:{}", file, line.number);
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (!number_in(fields[i], best.dialect.decimal))
      throw IoError(place, fmt::format("found '{}' in column {}; expected a finite number",
                                       fields[i], i + 1));
  throw IoError(place, fmt::format("found {} columns; expected {} as in line {}", fields.size(),
                                   best.columns, lines[best.first].number));
}

/// The one dialect in which the file is a table of numbers.
Reading chosen_reading(const std::vector<Line>& lines, std::string_view file, DecimalMark decimal) {
  constexpr std::array<Dialect, 7> dialects{
      {{'\t', '.'}, {'\t', ','}, {';', '.'}, {';', ','}, {',', '.'}, {' ', '.'}, {' ', ','}}};
  Reading best{.first = lines.size()};
  std::vector<Reading> complete;
  for (const Dialect dialect : dialects) {
    if (decimal != DecimalMark::automatic &&
        dialect.decimal != (decimal == DecimalMark::comma ? ',' : '.'))
      continue;
    const Reading reading = reading_of(lines, dialect);
    if (reading.complete) complete.push_back(reading);
    if (reading.rows == 0) continue;
    const auto rank = [](const Reading& r) {
      return std::tuple(-static_cast<std::ptrdiff_t>(r.first), r.rows, r.columns);
    };
    if (best.rows == 0 || rank(reading) > rank(best)) best = reading;
  }
  // Numbers begin where any dialect finds the first: a row that others cannot read is no header.
  std::erase_if(complete, [&](const Reading& r) { return r.first > best.first; });
  if (complete.empty()) refuse(lines, best, file);
  // Readings that split more mean the same, except that commas may be either.
  const Reading* point = nullptr;
  const Reading* comma = nullptr;
  for (const Reading& reading : complete) {
    const Reading*& slot = reading.dialect.decimal == '.' ? point : comma;
    if (slot == nullptr || reading.columns > slot->columns) slot = &reading;
  }
  if (point == nullptr) return *comma;
  if (comma == nullptr || point->dialect.delimiter != ',') return *point;
  return settle_commas(lines, *point, *comma, file);
}

constexpr EnumWords<DecimalMark, 3> mark_words("DecimalMark", "decimal mark",
                                               words_of(DecimalMark{}));

}  // namespace

DecimalMark parse_decimal_mark(std::string_view word) { return mark_words.parse(word); }

InstrumentTable parse_instrument_table(std::string_view text, std::string_view file,
                                       DecimalMark decimal) {
  const std::vector<Line> lines = lines_of(text);
  const Reading reading = chosen_reading(lines, file, decimal);
  InstrumentTable table;
  table.values.resize(static_cast<Eigen::Index>(reading.rows),
                      static_cast<Eigen::Index>(reading.columns));
  for (std::size_t r = 0; r < reading.rows; ++r) {
    const Line& line = lines[reading.first + r];
    const auto numbers = numbers_in(line.text, reading.dialect);
    for (std::size_t c = 0; c < reading.columns; ++c) {
      const double value = (*numbers)[c];
      if (!std::isfinite(value))
        throw IoError(fmt::format("{}:{}", file, line.number),
                      fmt::format("found '{}' in column {}; expected a finite number",
                                  split(line.text, reading.dialect.delimiter)[c], c + 1));
      table.values(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = value;
    }
    table.lines.push_back(line.number);
  }
  if (reading.first > 0) {
    const auto names = split(lines[reading.first - 1].text, reading.dialect.delimiter);
    if (names.size() == reading.columns) table.names.assign(names.begin(), names.end());
    const std::size_t skipped = reading.first - (table.names.empty() ? 0 : 1);
    if (skipped > 0)
      table.notes.push_back(fmt::format("{}: {} line{} of text before the numbers {} skipped", file,
                                        skipped, skipped == 1 ? "" : "s",
                                        skipped == 1 ? "was" : "were"));
  }
  if (reading.dialect.decimal == ',')
    table.notes.push_back(fmt::format("{}: commas were read as decimal marks", file));
  return table;
}

InstrumentTable read_instrument_table(const std::filesystem::path& path, DecimalMark decimal) {
  return parse_instrument_table(read_text_file(path), path.string(), decimal);
}

double seconds_per_unit(std::string_view column_name) {
  std::string lower(column_name);
  std::ranges::transform(lower, lower.begin(), lower_case);
  // The last word: what stands in brackets or after an underscore.
  while (!lower.empty() && !is_letter(lower.back())) lower.pop_back();
  std::size_t begin = lower.size();
  while (begin > 0 && is_letter(lower[begin - 1])) --begin;
  const std::string unit = lower.substr(begin);
  constexpr std::array<std::pair<std::string_view, double>, 8> units{{{"s", 1.0},
                                                                      {"second", 1.0},
                                                                      {"seconds", 1.0},
                                                                      {"ms", 1e-3},
                                                                      {"us", 1e-6},
                                                                      {"ns", 1e-9},
                                                                      {"ps", 1e-12},
                                                                      {"sec", 1.0}}};
  for (const auto& [name, seconds] : units)
    if (unit == name) return seconds;
  return 0.0;
}

}  // namespace tofsmith
