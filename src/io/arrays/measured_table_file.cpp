// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/measured_table_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/arrays/shared/array_matrix.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/number_table.hpp"

namespace tofsmith {

namespace {

constexpr Eigen::Index max_table_samples = 65536, max_table_measurements = 64;

/// Prefix of arrays such as correction_height.
constexpr std::string_view correction_prefix = "correction_";

/// Includes the fields of nested DepthErrorTerms.
template <typename Struct, typename Visit>
void for_each_array(Struct& its, const std::string& prefix, const Visit& visit) {
  for_each_field(its, [&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(field.value)>;
    const std::string name = prefix + field.name;
    if constexpr (std::is_same_v<Value, DepthErrorTerms>)
      for_each_array(field.value, name + "_", visit);
    else
      visit(name, field.value);
  });
}

std::vector<double> read_numbers(const NpzReader& archive, const std::string& file,
                                 const std::string& name) {
  const NpyArray array = archive.read(name);
  if (array.axes() > 1)
    throw IoError(fmt::format("{}: {}", file, name),
                  fmt::format("found the shape {}; expected one number or a list",
                              describe_shape(array.shape())));
  return array.to_doubles();
}

/// Returns none if the archive has no depth correction.
/// @throws IoError naming file and array if it is missing, invalid or of another shape
std::optional<DepthCorrection> correction_of(const NpzReader& archive, const std::string& file) {
  if (!archive.contains(std::string(correction_prefix) + "height")) return std::nullopt;
  DepthCorrection correction;
  for_each_array(
      correction, std::string(correction_prefix), [&](const std::string& name, auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        const std::vector<double> numbers = read_numbers(archive, file, name);
        if constexpr (std::is_arithmetic_v<Value>) {
          constexpr auto largest = static_cast<double>(std::numeric_limits<Value>::max());
          if (numbers.size() != 1 || !(std::abs(numbers[0]) <= largest))
            throw IoError(fmt::format("{}: {}", file, name), "expected one finite number");
          value = static_cast<Value>(numbers[0]);
        } else {
          value = Eigen::Map<const Eigen::VectorXd>(numbers.data(),
                                                    static_cast<Eigen::Index>(numbers.size()));
        }
      });
  try {
    correction.validate();
  } catch (const std::invalid_argument& error) {
    throw IoError(file, error.what());
  }
  return correction;
}

bool can_be_table(Eigen::Index samples, Eigen::Index measurements) {
  return samples >= min_samples && samples <= max_table_samples && measurements >= 1 &&
         measurements <= max_table_measurements;
}

void turn(Eigen::MatrixXd& matrix, const std::string& place, std::optional<TableAxes> axes,
          std::vector<std::string>& notes) {
  const Eigen::Index rows = matrix.rows(), columns = matrix.cols();
  const bool upright = can_be_table(rows, columns), lying = can_be_table(columns, rows);
  const bool expects_lying = axes == TableAxes::measurements_first;
  if (axes ? !(expects_lying ? lying : upright) : !(upright || lying))
    throw IoError(place, fmt::format("found the shape ({}, {}); expected {} with N in [{}, {}] and "
                                     "K at most {}",
                                     rows, columns, expects_lying ? "(K, N)" : "(N, K)",
                                     min_samples, max_table_samples, max_table_measurements));
  if (!axes && upright && lying && rows <= columns)
    throw IoError(place, fmt::format("found the shape ({}, {}), which could be (N, K) or (K, N); "
                                     "expected the axes, --table-axes nk or kn",
                                     rows, columns));
  if (!(axes ? expects_lying : !upright)) return;
  matrix.transposeInPlace();
  if (!axes)
    notes.push_back(fmt::format(
        "{}: its shape ({}, {}) was interpreted as (K, N): {} measurements of {} samples", place,
        rows, columns, rows, columns));
}

/// Relative to the largest value.
double distance(const Eigen::MatrixXd& matrix, Eigen::Index a, Eigen::Index b) {
  const double largest = matrix.cwiseAbs().maxCoeff();
  return largest > 0.0 ? (matrix.row(a) - matrix.row(b)).cwiseAbs().maxCoeff() / largest : 0.0;
}

void drop_repeated_end(Eigen::MatrixXd& matrix, const std::string& place,
                       std::vector<std::string>& notes) {
  constexpr double rounding = 1e-6;
  const Eigen::Index last = matrix.rows() - 1;
  if (distance(matrix, last, 0) > rounding) return;
  if (distance(matrix, last, last - 1) <= rounding || distance(matrix, 0, 1) <= rounding) {
    notes.push_back(
        fmt::format("{}: its last sample equals the first, but so do their "
                    "neighbours: all {} were kept",
                    place, last + 1));
    return;
  }
  if (last < min_samples)
    throw IoError(place, fmt::format("found {} samples and a repeated end point; expected at least "
                                     "{} samples of the period",
                                     last, min_samples));
  matrix.conservativeResize(last, Eigen::NoChange);
  notes.push_back(
      fmt::format("{}: its last sample repeats the first and was dropped: N = {}, which makes "
                  "depths {:.3g} % larger (--keep-end-point keeps it)",
                  place, last, 100.0 / static_cast<double>(last)));
}

/// Returns one number per column; empty if the archive has none.
Eigen::VectorXd list_of(const NpzReader& archive, const std::string& file, const char* name,
                        Eigen::Index columns) {
  if (!archive.contains(name)) return {};
  const NpyArray array = archive.read(name);
  const std::string place = fmt::format("{}: {}", file, name);
  if (array.axes() != 1 || array.size() != static_cast<std::size_t>(columns))
    throw IoError(place, fmt::format("found the shape {}; expected ({},), one number per column of "
                                     "corrfs",
                                     describe_shape(array.shape()), columns));
  const std::vector<double> values = array.to_doubles();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw IoError(fmt::format("{}[{}]", place, i),
                    fmt::format("found {}; expected a finite number", values[i]));
  return Eigen::Map<const Eigen::VectorXd>(values.data(), columns);
}

/// Returns none if the scalar is missing.
template <typename Check>
std::optional<double> number(const NpzReader& archive, const std::string& file, const char* name,
                             const Check& is_valid, std::string_view rule) {
  if (!archive.contains(name)) return std::nullopt;
  const NpyArray array = archive.read(name);
  const double value = array.size() == 1 ? array.to_doubles().front() : NAN;
  if (array.size() != 1 || !is_valid(value))
    throw IoError(
        fmt::format("{}: {}", file, name),
        fmt::format("found {}; expected one {}",
                    array.size() == 1 ? fmt::format("{}", value) : describe_shape(array.shape()),
                    rule));
  return value;
}

std::optional<int> whole_number(const NpzReader& archive, const std::string& file,
                                const char* name) {
  const auto is_whole = [](double value) {
    return value >= 0.0 && value <= 64.0 && value == std::floor(value);
  };
  const auto value = number(archive, file, name, is_whole, "whole number, 0 to 64");
  return value ? std::optional(static_cast<int>(*value)) : std::nullopt;
}

/// `taps` adjacent columns per exposure; an order given by the user must agree.
TapLayout layout_of(const NpzReader& archive, const std::string& file, const TapLayout& given) {
  const std::optional<int> taps = whole_number(archive, file, "taps");
  if (!taps) return given;
  if (given.order == TapOrder::blocked && *taps > 1)
    throw IoError(fmt::format("{}: taps", file),
                  "its columns contain the taps of each exposure next to each other; expected "
                  "--tap-order interleaved, or none");
  return {.taps = *taps, .order = TapOrder::interleaved};
}

void note_unused(const NpzReader& archive, const std::string& file,
                 std::vector<std::string>& notes) {
  constexpr std::array<std::string_view, 9> known = {
      "corrfs",    "ambient", "exposure_s",  "offset_dn",          "gain_e_per_dn",
      "corrfs_se", "taps",    "differences", "model_error_percent"};
  std::vector<std::string> unused;
  for (const std::string& name : archive.names())
    if (std::ranges::find(known, name) == known.end() && !name.starts_with(correction_prefix))
      unused.push_back(name);
  if (!unused.empty())
    notes.push_back(fmt::format("{}: not used: {}", file, fmt::join(unused, ", ")));
}

void sort_columns(MeasuredTable& table, const TapLayout& layout, const std::string& file) {
  if (layout.taps > 1 && table.columns() > layout.taps && !layout.order)
    throw IoError(
        file,
        fmt::format(
            "found {0} columns for a camera with {1} taps; expected every tap of each exposure, "
            "with --tap-order blocked or interleaved, or --taps 1 if they belong to one tap, or an "
            ".npz file with corrfs and differences = 1 if they are differences of two",
            table.columns(), layout.taps));
  const int exposures = exposures_of(table.columns(), layout, file);
  table.taps = layout.taps;
  Eigen::VectorXi source(table.columns());
  for (int e = 0; e < exposures; ++e)
    for (int t = 0; t < layout.taps; ++t)
      source[e * layout.taps + t] =
          static_cast<int>(column_of(e, t, exposures, layout.taps, layout.order));
  table = table.in_order(source);
}

}  // namespace

Eigen::MatrixXd read_correlation_functions(const std::filesystem::path& path) {
  std::vector<std::string> notes;
  Eigen::MatrixXd functions = correlation_matrix_of(path, notes);
  if (functions.rows() < min_samples)
    throw IoError(path.string(), fmt::format("found {} samples of the period; expected at least {}",
                                             functions.rows(), min_samples));
  return functions;
}

bool is_correlation_table(const std::string& name_or_path) {
  const std::string extension = lower_extension(name_or_path);
  return is_number_table(name_or_path) || extension == ".npy" || extension == ".npz";
}

TargetSet load_target(const std::string& name_or_path, const Camera& camera, bool normalize) {
  const std::filesystem::path path = name_or_path;
  if (is_correlation_table(name_or_path))
    return targets_from_table(path.stem().string(), read_correlation_functions(path),
                              camera.samples, normalize);
  require(!normalize, "normalize", "true", "is only valid with a target that is a table");
  return targets_of(load_code(name_or_path, ideal_camera(camera)).resampled(camera.samples));
}

bool is_measured_table(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".csv" && holds_code_columns(path)) return false;
  if (extension != ".npz") return is_number_table(path) || extension == ".npy";
  const NpzReader archive(path);
  return archive.contains("corrfs") && !archive.contains("modfs") && !archive.contains("demodfs");
}

MeasuredTableFile read_measured_table(const std::filesystem::path& path,
                                      const MeasuredTableOptions& options) {
  MeasuredTableFile file;
  TapLayout layout = options.layout;
  MeasuredTable& table = file.table;
  const std::string name = path.string();
  table.correlation = correlation_matrix_of(path, file.notes);
  turn(table.correlation, name, options.axes, file.notes);
  if (!options.keep_end_point) drop_repeated_end(table.correlation, name, file.notes);
  if (lower_extension(path) == ".npz") {
    const NpzReader archive(path);
    table.ambient_gain = list_of(archive, name, "ambient", table.columns());
    table.exposure_s = list_of(archive, name, "exposure_s", table.columns());
    table.black_level = list_of(archive, name, "offset_dn", table.columns());
    table.gain_e_per_raw = list_of(archive, name, "gain_e_per_dn", table.columns());
    note_unused(archive, name, file.notes);
    table.correction = correction_of(archive, name);
    table.model_error_percent =
        number(
            archive, name, "model_error_percent",
            [](double value) { return value >= 0.0 && value <= 100.0; }, "number in [0, 100]")
            .value_or(0.0);
    layout = layout_of(archive, name, layout);
    table.differences = whole_number(archive, name, "differences").value_or(0) != 0;
    if (table.differences) layout.taps = 1;
  }
  sort_columns(table, layout, name);
  return file;
}

void add_correction(const DepthCorrection& correction, NpzArrays& arrays) {
  for_each_array(correction, std::string(correction_prefix),
                 [&](const std::string& name, const auto& value) {
                   std::vector<double> numbers;
                   NpyShape shape;
                   if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
                     numbers = {static_cast<double>(value)};
                   } else {
                     numbers.assign(value.data(), value.data() + value.size());
                     shape = {numbers.size()};
                   }
                   arrays.emplace(name, NpyArray::of<double>(shape, numbers));
                 });
}

}  // namespace tofsmith
