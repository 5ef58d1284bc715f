// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/code_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "core/shared/periodic.hpp"
#include "io/arrays/shared/array_matrix.hpp"
#include "io/text/shared/text_lines.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/number_table.hpp"

namespace tofsmith {

namespace {

// Relative to the largest value: allows for rounding errors of Fourier transforms.
constexpr double transform_noise = 1e-9;
constexpr Eigen::Index max_rows = 65536;  // as for cameras
constexpr Eigen::Index max_columns = 4096;

struct NamedMatrix {
  std::string place;
  Eigen::MatrixXd values;
};

NamedMatrix read_matrix(const NpzReader& reader, std::string_view file, const char* name) {
  const std::string place = fmt::format("{}: {}", file, name);
  NamedMatrix matrix{place, matrix_of(reader.read(name), place)};
  const Eigen::Index samples = matrix.values.rows(), columns = matrix.values.cols();
  if (samples < 2 || samples > max_rows || columns > max_columns)
    throw IoError(place, fmt::format("found the shape ({}, {}); expected (N, K) with N in [2, {}] "
                                     "and K at most {}",
                                     samples, columns, max_rows, max_columns));
  return matrix;
}

void require_same_shape(const NamedMatrix& matrix, const NamedMatrix& other) {
  if (matrix.values.rows() == other.values.rows() && matrix.values.cols() == other.values.cols())
    return;
  throw IoError(matrix.place, fmt::format("found the shape ({}, {}); expected ({}, {}) as of {}",
                                          matrix.values.rows(), matrix.values.cols(),
                                          other.values.rows(), other.values.cols(), other.place));
}

/// Clamps values within rounding errors and rejects all others.
void limit(NamedMatrix& matrix, double lowest, double highest, std::string_view expected) {
  for (Eigen::Index n = 0; n < matrix.values.rows(); ++n)
    for (Eigen::Index i = 0; i < matrix.values.cols(); ++i) {
      double& value = matrix.values(n, i);
      if (value < lowest - transform_noise || value > highest + transform_noise)
        throw IoError(fmt::format("{}[{}, {}]", matrix.place, n, i),
                      fmt::format("found {}; expected {}", value, expected));
      value = std::clamp(value, lowest, highest);
    }
}

Waveform waveform_of(const Eigen::VectorXd& samples) {
  const double peak = samples.maxCoeff();
  if (peak == 0.0) return Waveform::constant(0.0);
  const double near = transform_noise * peak;
  const bool two_levels = ((samples.array() <= near) || (samples.array() >= peak - near)).all();
  return two_levels ? Waveform::binary_from_samples(samples, peak) : Waveform::sampled(samples);
}

std::vector<Waveform> waveforms_of(const Eigen::MatrixXd& columns) {
  std::vector<Waveform> list;
  for (Eigen::Index i = 0; i < columns.cols(); ++i) list.push_back(waveform_of(columns.col(i)));
  return list;
}

constexpr std::string_view modulation_rule = "power over average power, >= 0";
constexpr std::string_view demodulation_rule = "a gain in [0, 1]";
constexpr std::string_view gate_rule =
    "a gain in [0, 1]; signed weights require a camera with sensor.readout = \"rows\" or "
    "sensor.demodulation = \"signed\"";
constexpr std::string_view weight_rule = "a weight in [-1, 1]";

/// Gains, or the weights of a mixer, one per column.
struct Demodulations {
  std::vector<Waveform> gains;
  std::optional<Eigen::MatrixXd> weights = {};
};

CodeSet created(std::string_view file, Eigen::Index samples, int taps,
                std::vector<Waveform> modulation, Demodulations demodulation) {
  if (samples < 2 || samples > max_rows)
    throw IoError(file, fmt::format("found {} samples; expected 2 to {}", samples, max_rows));
  const std::string name = std::filesystem::path(file).stem().string();
  try {
    if (demodulation.weights)
      return CodeSet::create_signed(name, std::move(modulation), *demodulation.weights);
    return CodeSet::create(name, static_cast<int>(samples), taps, std::move(modulation),
                           std::move(demodulation.gains));
  } catch (const std::invalid_argument& error) {
    throw IoError(file, error.what());
  }
}

/// The longer axis is time and becomes the row axis.
NamedMatrix read_columns(const std::filesystem::path& path) {
  const std::string place = path.string();
  NamedMatrix matrix{place, columns_of(read_npy(path), place)};
  if (matrix.values.cols() > matrix.values.rows()) matrix.values.transposeInPlace();
  return matrix;
}

void require_same_light(const NamedMatrix& modulation, Eigen::Index column, Eigen::Index first) {
  for (Eigen::Index n = 0; n < modulation.values.rows(); ++n) {
    const double value = modulation.values(n, column), expected = modulation.values(n, first);
    if (std::abs(value - expected) <= transform_noise * std::max(1.0, std::abs(expected))) continue;
    throw IoError(fmt::format("{}[{}, {}]", modulation.place, n, column),
                  fmt::format("found {}; expected {} as in column {}, a tap of the same exposure",
                              value, expected, first));
  }
}

CodeSet code_of_columns(std::string_view file, NamedMatrix modulation, NamedMatrix demodulation,
                        const TapLayout& layout) {
  limit(modulation, 0.0, std::numeric_limits<double>::infinity(), modulation_rule);
  if (layout.is_signed)
    limit(demodulation, -1.0, 1.0, weight_rule);
  else
    limit(demodulation, 0.0, 1.0, demodulation_rule);

  const int exposures = exposures_of(modulation.values.cols(), layout, file);
  if (layout.is_signed)
    return created(file, modulation.values.rows(), 1, waveforms_of(modulation.values),
                   {{}, std::move(demodulation.values)});
  std::vector<Waveform> light, gains;
  for (int e = 0; e < exposures; ++e) {
    const Eigen::Index first = column_of(e, 0, exposures, layout.taps, layout.order);
    light.push_back(waveform_of(modulation.values.col(first)));
    for (int t = 0; t < layout.taps; ++t) {
      const Eigen::Index column = column_of(e, t, exposures, layout.taps, layout.order);
      require_same_light(modulation, column, first);
      gains.push_back(waveform_of(demodulation.values.col(column)));
    }
  }
  return created(file, modulation.values.rows(), layout.taps, std::move(light), {std::move(gains)});
}

}  // namespace

bool holds_code_columns(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string head(std::size_t{1} << 16, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return std::ranges::any_of(content_lines(head), [](const TextLine& line) {
    return line.text.find("modulation_") != std::string_view::npos;
  });
}

CodeSet parse_code_csv(std::string_view text, std::string_view file, bool is_signed) {
  const NumberTable table = parse_number_table(text, file);
  std::vector<Eigen::Index> modulations, demodulations;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const std::string& name = table.names[i];
    if (name.starts_with("modulation_"))
      modulations.push_back(static_cast<Eigen::Index>(i));
    else if (name.starts_with("demodulation_"))
      demodulations.push_back(static_cast<Eigen::Index>(i));
    else if (name != "time_s")
      throw IoError(
          file,
          fmt::format(
              "found the column '{}'; expected time_s, modulation_1, ... or demodulation_1, ...",
              name));
  }
  if (modulations.empty() || demodulations.empty() ||
      demodulations.size() % modulations.size() != 0)
    throw IoError(
        file,
        fmt::format(
            "found {} columns modulation_1, ... and {} columns demodulation_1, ...; expected at "
            "least one modulation, and an equal number of demodulations (taps) for each modulation",
            modulations.size(), demodulations.size()));
  const auto values = [&](const std::vector<Eigen::Index>& columns, double lowest, double highest,
                          std::string_view expected) {
    NamedMatrix matrix{fmt::format("{}: values", file), table.values(Eigen::all, columns)};
    limit(matrix, lowest, highest, expected);
    return matrix.values;
  };
  Demodulations demodulation;
  if (is_signed)
    demodulation.weights = values(demodulations, -1.0, 1.0, weight_rule);
  else
    demodulation.gains = waveforms_of(values(demodulations, 0.0, 1.0, demodulation_rule));
  return created(file, table.values.rows(),
                 static_cast<int>(demodulations.size() / modulations.size()),
                 waveforms_of(values(modulations, 0.0, std::numeric_limits<double>::infinity(),
                                     modulation_rule)),
                 std::move(demodulation));
}

CodeSet parse_code_npz(std::span<const std::byte> content, std::string_view file,
                       const TapLayout& layout) {
  const NpzReader reader(content, file);
  if (!reader.contains("modfs") && !reader.contains("corrfs"))
    throw IoError(file, fmt::format("found the arrays {}; expected modfs and demodfs, a code, or "
                                    "corrfs, a measured table",
                                    fmt::join(reader.names(), ", ")));
  NamedMatrix modulation = read_matrix(reader, file, "modfs");
  NamedMatrix demodulation = read_matrix(reader, file, "demodfs");
  require_same_shape(demodulation, modulation);
  if (reader.contains("corrfs"))
    require_same_shape(read_matrix(reader, file, "corrfs"), modulation);
  return code_of_columns(file, std::move(modulation), std::move(demodulation), layout);
}

CodeSet read_code_arrays(const std::filesystem::path& light, const std::filesystem::path& gates,
                         const TapLayout& layout) {
  NamedMatrix modulation = read_columns(light), demodulation = read_columns(gates);
  if (modulation.values.cols() == 1)
    modulation.values = modulation.values.replicate(1, demodulation.values.cols()).eval();
  require_same_shape(demodulation, modulation);
  limit(modulation, 0.0, std::numeric_limits<double>::infinity(), modulation_rule);
  const double brightest = modulation.values.colwise().mean().maxCoeff();
  if (brightest == 0.0) throw IoError(modulation.place, "found only zeros; expected light");
  modulation.values /= brightest;
  const double most = demodulation.values.cwiseAbs().maxCoeff();
  if (most > 1.0) demodulation.values /= most;
  if (!layout.is_signed) limit(demodulation, 0.0, 1.0, gate_rule);
  return code_of_columns(gates.string(), std::move(modulation), std::move(demodulation), layout);
}

std::vector<std::byte> serialize_code_npz(const CodeSet& code, std::optional<TapOrder> order) {
  require(code.taps() == 1 || code.exposures() == 1 || order.has_value(), "taps", code.taps(),
          "several taps and several exposures require an order, blocked or interleaved");
  const Eigen::MatrixXd light = code.modulation_samples(), gains = code.demodulation_samples();
  Eigen::MatrixXd modulation(code.samples(), code.measurements());
  Eigen::MatrixXd demodulation = modulation, correlation = modulation;
  for (int i = 0; i < code.measurements(); ++i) {
    const int e = code.exposure_of(i);
    const Eigen::Index column = column_of(e, i % code.taps(), code.exposures(), code.taps(), order);
    modulation.col(column) = light.col(e);
    demodulation.col(column) = gains.col(i);
    correlation.col(column) = circular_correlation(gains.col(i), light.col(e)) / code.samples();
  }
  return serialize_npz({{"modfs", array_of(modulation)},
                        {"demodfs", array_of(demodulation)},
                        {"corrfs", array_of(correlation)}});
}

namespace {

/// Returns the common light of all rows: (N), (N, 1), (1, N) or equal columns.
Eigen::VectorXd light_of(Eigen::MatrixXd light, const std::string& place) {
  if (light.rows() == 1) light.transposeInPlace();
  const double near = transform_noise * light.cwiseAbs().maxCoeff();
  for (Eigen::Index n = 0; n < light.rows(); ++n)
    for (Eigen::Index k = 0; k < light.cols(); ++k) {
      const std::string at = fmt::format("{}[{}, {}]", place, n, k);
      if (light(n, k) < -near)
        throw IoError(at, fmt::format("found {}; expected light, >= 0", light(n, k)));
      if (std::abs(light(n, k) - light(n, 0)) > near)
        throw IoError(at, fmt::format("found {}; expected {} as in column 0: all rows of one "
                                      "exposure share the same light",
                                      light(n, k), light(n, 0)));
    }
  const Eigen::VectorXd one = light.col(0).cwiseMax(0.0);
  if (one.isZero(0.0)) throw IoError(place, "found only zeros; expected light");
  return one;
}

/// Returns the weights as (N, K); (K, N) is transposed.
Eigen::MatrixXd rows_of_matrix(Eigen::MatrixXd rows, Eigen::Index time_bins,
                               const std::string& place) {
  const Eigen::Index found_rows = rows.rows(), found_columns = rows.cols();
  if (found_rows != time_bins && found_columns == time_bins) rows.transposeInPlace();
  if (rows.rows() != time_bins) {
    const bool has_end = found_rows == time_bins + 1 || found_columns == time_bins + 1 ||
                         found_rows == time_bins - 1 || found_columns == time_bins - 1;
    throw IoError(place, fmt::format("found the shape ({}, {}); expected (N, K) or (K, N) with the "
                                     "N = {} time bins of the light{}",
                                     found_rows, found_columns, time_bins,
                                     has_end ? "; a period omits its end point" : ""));
  }
  if (rows.cols() < 2 || rows.cols() > max_exposure_rows)
    throw IoError(place, fmt::format("found {} rows of {} time bins; expected 2 to {} rows",
                                     rows.cols(), time_bins, max_exposure_rows));
  for (Eigen::Index k = 0; k < rows.cols(); ++k)
    if (rows.col(k).isZero(0.0))
      throw IoError(place, fmt::format("found only zeros in row {}; expected weights", k));
  return rows;
}

CodeSet rows_from(const std::string& name, Eigen::MatrixXd light, const std::string& light_place,
                  Eigen::MatrixXd rows, const std::string& rows_place) {
  const Eigen::VectorXd one = light_of(std::move(light), light_place);
  if (one.size() < min_samples || one.size() > max_rows)
    throw IoError(light_place, fmt::format("found {} time bins; expected {} to {}", one.size(),
                                           min_samples, max_rows));
  const Eigen::MatrixXd weights = rows_of_matrix(std::move(rows), one.size(), rows_place);
  return CodeSet::create_rows(name, one, weights);
}

}  // namespace

CodeSet read_rows(const std::filesystem::path& light, const std::filesystem::path& rows) {
  return rows_from(rows.stem().string(), columns_of(read_npy(light), light.string()),
                   light.string(), columns_of(read_npy(rows), rows.string()), rows.string());
}

CodeSet read_rows(const std::filesystem::path& archive) {
  const NpzReader reader(archive);
  const std::string light = archive.string() + ": modfs", rows = archive.string() + ": demodfs";
  return rows_from(archive.stem().string(), columns_of(reader.read("modfs"), light), light,
                   columns_of(reader.read("demodfs"), rows), rows);
}

std::string waveforms_to_csv(const CodeSet& code, double fundamental_frequency_hz) {
  std::string text = "time_s";
  for (int e = 0; e < code.exposures(); ++e) text += fmt::format(",modulation_{}", e + 1);
  for (int i = 0; i < code.measurements(); ++i) text += fmt::format(",demodulation_{}", i + 1);
  text += "\n";
  const Eigen::MatrixXd modulation = code.modulation_samples();
  const Eigen::MatrixXd demodulation = code.demodulation_samples();
  for (int n = 0; n < code.samples(); ++n) {
    text += fmt::format("{:.9g}", n / (fundamental_frequency_hz * code.samples()));
    for (int e = 0; e < code.exposures(); ++e) text += fmt::format(",{:.9g}", modulation(n, e));
    for (int i = 0; i < code.measurements(); ++i)
      text += fmt::format(",{:.9g}", demodulation(n, i));
    text += "\n";
  }
  return text;
}

}  // namespace tofsmith
