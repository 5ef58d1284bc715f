// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Separator of the whole part and the fraction of a number in a text.
enum class DecimalMark { automatic, point, comma };

constexpr std::array<std::string_view, 3> words_of(DecimalMark /*any*/) {
  return {"auto", "point", "comma"};
}
/// "auto", "point" or "comma". @throws std::invalid_argument for any other word
DecimalMark parse_decimal_mark(std::string_view word);

/// Constraints on the interpretation of a text as a table.
struct NumberTableOptions {
  DecimalMark decimal = DecimalMark::automatic;
  std::size_t min_columns = 1;  ///< fewer are only accepted if the text has no other interpretation
  std::size_t max_columns = std::numeric_limits<std::size_t>::max();  ///< same for more
};

/// A table of numbers, as instruments, spreadsheets and users write it.
struct NumberTable {
  std::vector<std::string> names;        ///< of the columns, from the line above the first row
  std::vector<std::string> upper_names;  ///< from the line above `names`; either may be empty
  Eigen::MatrixXd values;                ///< (rows, columns), each is_measured()
  std::vector<std::size_t> lines;        ///< of the file, counted from 1, one per row
  std::size_t first_column = 1;          ///< number in the file of the first column of values
  std::vector<std::vector<std::string>> header;  ///< cells above the rows and to their left
  std::vector<std::string> notes;                ///< how the file was interpreted

  /// Index of the column with a name (also without its unit, in any case) or a number in the file.
  /// @param file  what errors call it
  /// @throws IoError if there is none, or several of the name
  Eigen::Index column_of(std::string_view name_or_number, std::string_view file) const;
  /// Number of columns and names for messages: "3 columns (X s, CH1 V, CH2 V)".
  std::string describe_columns() const;
};

/// Reads columns between tabs, semicolons, commas or blanks, with decimal points or commas. Fields
/// may have quotes, lines may end with separators. Lines of text may precede the rows, the last two
/// of which may name the columns; a header may also fill the columns left of the numbers. The
/// separators are found by reading the text each way. A text with two interpretations, such as
/// lines of "1,5", is refused unless its header, rising whole numbers or the options settle it.
/// Empty lines and lines that begin with '#' are skipped.
/// @param file  what errors call it
/// @throws IoError "file:line:column: .." for a field that is not is_measured(), rows of different
///         lengths, no row at all, or two interpretations
NumberTable parse_number_table(std::string_view text, std::string_view file,
                               const NumberTableOptions& options = {});
NumberTable read_number_table(const std::filesystem::path& path,
                              const NumberTableOptions& options = {});

/// Reads a table of one column, or of one next to a counter of the rows. @throws IoError also for
/// several columns
/// @param content  content of the column, for errors: "the temperatures"
NumberTable read_number_column(const std::filesystem::path& path, std::string_view content,
                               DecimalMark decimal = DecimalMark::automatic);

/// Returns whether a file has an extension of such tables: .csv .txt .tsv .dat, in any case.
bool is_number_table(const std::filesystem::path& path);

/// Returns whether a number can be a measured value: finite, and not one of the values by which
/// SCPI instruments report infinity (9.9e37) and not-a-number (9.91e37).
bool is_measured(double number);

/// Seconds per unit of a column's name: "time_ns", "Time (us)", "delay [ps]", "second"; 0 if the
/// name has no unit of time.
double seconds_per_unit(std::string_view column_name);

}  // namespace tofsmith
