// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/shared/text_numbers.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

struct TextField {
  std::string_view text;
  std::size_t column;  // counted from 1
};

/// The fields of one line; what stands between two separators may be empty.
std::vector<TextField> split(std::string_view line) {
  constexpr std::string_view blanks = " \t\r";
  std::vector<TextField> fields;
  std::size_t at = line.find_first_not_of(blanks);
  while (at < line.size()) {
    const std::size_t end = std::min(line.find_first_of(" \t\r,;", at), line.size());
    fields.push_back({line.substr(at, end - at), at + 1});
    at = line.find_first_not_of(blanks, end);
    if (at >= line.size() || (line[at] != ',' && line[at] != ';')) continue;
    at = line.find_first_not_of(blanks, at + 1);
    if (at >= line.size()) fields.push_back({"", line.size() + 1});  // a separator ended the line
  }
  return fields;
}

bool names_columns(const std::vector<TextField>& fields) {
  for (const TextField& field : fields)
    if (field.text.empty() || number_in(field.text)) return false;
  return true;
}

}  // namespace

CsvTable parse_csv(std::string_view text, std::string_view file) {
  CsvTable table;
  std::vector<double> values;
  std::size_t columns = 0, rows = 0, line_number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    ++line_number;
    const std::vector<TextField> fields = split(line);
    if (fields.empty() || fields[0].text.starts_with('#')) continue;
    const auto place = [&](std::size_t column) {
      return fmt::format("{}:{}:{}", file, line_number, column);
    };
    const bool first = columns == 0;
    if (first) columns = fields.size();
    if (fields.size() != columns)
      throw IoError(place(1), fmt::format("found {} columns; expected {} as in the first row",
                                          fields.size(), columns));
    if (first && names_columns(fields)) {
      for (const TextField& field : fields) table.names.emplace_back(field.text);
      continue;
    }
    for (const TextField& field : fields) {
      const std::optional<double> number = number_in(field.text);
      if (!number || !std::isfinite(*number))
        throw IoError(place(field.column),
                      fmt::format("found '{}'; expected a finite number", field.text));
      values.push_back(*number);
    }
    ++rows;
  }
  if (rows == 0) throw IoError(file, "found no row of numbers; expected at least one");
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  table.values = Eigen::Map<const RowMajor>(values.data(), static_cast<Eigen::Index>(rows),
                                            static_cast<Eigen::Index>(columns));
  return table;
}

CsvTable read_csv(const std::filesystem::path& path) {
  return parse_csv(read_text_file(path), path.string());
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace tofsmith
