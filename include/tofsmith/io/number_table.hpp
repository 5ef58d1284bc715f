// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/fields.hpp"

namespace tofsmith {

/// Decimal separator of the numbers in a text.
enum class DecimalMark { automatic, point, comma };

constexpr auto words_of(DecimalMark /*any*/) { return word_list("auto", "point", "comma"); }

/// Constraints on the interpretation of a text.
struct NumberTableOptions {
  DecimalMark decimal = DecimalMark::automatic;
  std::size_t min_columns = 1;  ///< fewer only if there is no other interpretation
  std::size_t max_columns = std::numeric_limits<std::size_t>::max();  ///< as min_columns
};

/// A table of numbers from instruments, spreadsheets or users.
struct NumberTable {
  std::vector<std::string> names;                ///< of the columns; may be empty
  std::vector<std::string> upper_names;          ///< from the line above `names`
  Eigen::MatrixXd values;                        ///< (rows, columns)
  std::vector<std::size_t> lines;                ///< in the file, from 1
  std::size_t first_column = 1;                  ///< number in the file of the first column
  std::vector<std::vector<std::string>> header;  ///< cells above and to the left of the rows
  std::vector<std::string> notes;

  /// Returns the index of a column by name (case-insensitive, unit optional) or number in the file.
  /// @throws IoError if there is no such column, or several with the name
  Eigen::Index column_of(std::string_view name_or_number, std::string_view file) const;
  /// Returns the columns for messages: "3 columns (X s, CH1 V, CH2 V)".
  std::string describe_columns() const;
};

/// Reads columns separated by tabs, semicolons, commas or blanks, with decimal points or commas.
/// Lines of text may precede the rows, the last two with names of the columns; header columns may
/// precede the numbers. A text with two interpretations, such as lines of "1,5", is rejected unless
/// its header, increasing integers or the options decide. Lines that begin with '#' are skipped.
/// @throws IoError "file:line:column: ..." for a field that is not is_measured(), rows of different
///         lengths, no rows, or two interpretations
NumberTable parse_number_table(std::string_view text, std::string_view file,
                               const NumberTableOptions& options = {});
NumberTable read_number_table(const std::filesystem::path& path,
                              const NumberTableOptions& options = {});

/// Reads a table of one column, optionally preceded by a row counter.
/// @param content  for errors: "the temperatures"
NumberTable read_number_column(const std::filesystem::path& path, std::string_view content,
                               DecimalMark decimal = DecimalMark::automatic);

/// Returns true for .csv .txt .tsv .dat, case-insensitive.
bool is_number_table(const std::filesystem::path& path);

/// Returns true for finite numbers except the values that SCPI instruments report for infinity
/// (9.9e37) and not-a-number (9.91e37).
bool is_measured(double number);

/// Returns the seconds per unit of a name such as "time_ns", "Time (us)", "delay [ps]"; 0 if it has
/// no unit of time.
double seconds_per_unit(std::string_view column_name);

}  // namespace tofsmith
