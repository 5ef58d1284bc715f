// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// A table of numbers.
struct CsvTable {
  std::vector<std::string> names;  ///< of the columns; empty when the file does not say
  Eigen::MatrixXd values;          ///< (rows, columns), finite
};

/// Reads rows of numbers between commas, semicolons, tabs or blanks. The first row may name the
/// columns. Empty lines and lines that begin with '#' are skipped.
/// @param file  what errors call it
/// @throws IoError "file:line:column: .." for anything but a finite number, for rows of different
///         lengths, or if there is no row
CsvTable parse_csv(std::string_view text, std::string_view file);
CsvTable read_csv(const std::filesystem::path& path);

/// A text as a field of a CSV file, quoted where it needs it (RFC 4180).
std::string csv_field(std::string_view text);

}  // namespace tofsmith
