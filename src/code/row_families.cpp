// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "code/row_families.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tofsmith {

namespace {

/// First rule that prevents a conversion to rows.
std::optional<BrokenRule> not_rows(const CodeSet& code) {
  const std::string what = "code " + code.name();
  if (code.is_rows()) return std::nullopt;
  if (code.taps() != 1)
    return broken(what + " taps", code.taps(), "must be 1 for rows of one exposure");
  if (code.measurements() < 2 || code.measurements() > max_exposure_rows)
    return broken(what + " measurements", code.measurements(),
                  fmt::format("must be in [2, {}] for rows of one exposure", max_exposure_rows));
  for (int i = 0; i < code.measurements(); ++i) {
    if (!(code.modulation(i) == code.modulation(0)))
      return broken(fmt::format("{} modulation {}", what, i), "different from modulation 0",
                    "must be equal: all rows of one exposure share one modulation");
    if (code.demodulation(i).peak() == 0.0)
      return broken(fmt::format("{} demodulation {}", what, i), "all zero",
                    "must have a nonzero weight");
  }
  return std::nullopt;
}

std::optional<BrokenRule> count_misfit(const char* family, int rows, int min_count,
                                       const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  if (rows >= min_count && rows <= max_exposure_rows) return std::nullopt;
  return broken(fmt::format("rows of {}", family), rows,
                fmt::format("must be in [{}, {}]", min_count, max_exposure_rows));
}

}  // namespace

std::optional<std::string> why_no_rows(const CodeSet& code) { return text_of(not_rows(code)); }

CodeSet rows_of(const CodeSet& code) {
  require(not_rows(code));
  if (code.is_rows()) return code;
  Eigen::MatrixXd rows = code.demodulation_samples();
  for (Eigen::Index k = 0; k < rows.cols(); ++k)
    if (rows.col(k).maxCoeff() > rows.col(k).minCoeff()) rows.col(k).array() -= rows.col(k).mean();
  CodeSet result = CodeSet::create_rows(code.name(), code.modulation(0), rows);
  result.provenance = code.provenance;
  return result;
}

std::optional<BrokenRule> fourier_rows_misfit(int rows, const FamilyOptions& options) {
  if (auto misfit = count_misfit("fourier", rows, 2, options)) return misfit;
  const int highest = (rows + 1) / 2;
  if (4 * highest <= options.samples) return std::nullopt;
  return broken("samples", options.samples,
                fmt::format("must be >= 4 x the highest frequency, {}", 4 * highest));
}

CodeSet fourier_rows(int rows, const FamilyOptions& options) {
  require(fourier_rows_misfit(rows, options));
  const int count = options.samples;
  Eigen::MatrixXd weights(count, rows);
  for (int k = 0; k < rows; ++k)
    for (int n = 0; n < count; ++n) {
      const int harmonic = k / 2 + 1;
      const double turn = 2 * std::numbers::pi * harmonic * (n + 0.5) / count;
      weights(n, k) = k % 2 == 0 ? std::cos(turn) : std::sin(turn);
    }
  return CodeSet::create_rows(fmt::format("fourier-k{}", rows),
                              rectangular_pulse(std::max(1.0 / options.peak_factor, 1.0 / count)),
                              weights);
}

std::optional<BrokenRule> histogram_rows_misfit(int rows, const FamilyOptions& options) {
  if (auto misfit = count_misfit("histogram", rows, 3, options)) return misfit;
  if (!options.exact_grid || options.samples % rows == 0) return std::nullopt;
  return broken(
      "samples", options.samples,
      fmt::format("must be a multiple of {0} for histogram-k{0}, whose gates must not be rounded",
                  rows));
}

CodeSet histogram_rows(int rows, const FamilyOptions& options) {
  require(histogram_rows_misfit(rows, options));
  Eigen::MatrixXd weights(options.samples, rows);
  for (int k = 0; k < rows; ++k) {
    const double begin = static_cast<double>(k) / rows;
    weights.col(k) = Waveform::binary({{begin, begin + 1.0 / rows}}).cell_averages(options.samples);
  }
  return CodeSet::create_rows(fmt::format("histogram-k{}", rows),
                              rectangular_pulse(std::max(1.0 / options.peak_factor, 1.0 / rows)),
                              weights);
}

}  // namespace tofsmith
