// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/factorize.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

TargetSet targets_of(const CodeSet& code) {
  require(code.taps() == 1, "taps of the target", code.taps(), "must be 1");
  TargetSet set{code.name(), {}};
  for (int i = 0; i < code.measurements(); ++i) {
    const Waveform& d = code.demodulation(i);
    const Waveform& m = code.modulation_of(i);
    set.measurements.push_back(
        {CorrelationFunction(d, m).table(code.samples()), d.mean(), WaveformPair{m, d}});
  }
  return set;
}

Camera ideal_camera(const Camera& camera) {
  Camera ideal = camera;
  ideal.sensor.taps = 1;
  ideal.sensor.readout = Readout::separate;
  ideal.sensor.decoder = RowDecoder::whitened;
  ideal.sensor.modulation_contrast = 1.0;
  ideal.sensor.modulation_contrasts.clear();
  ideal.light.peak_factor = 1e6;
  ideal.playback.reset();
  return ideal;
}

TargetSet targets_from_table(std::string name, const Eigen::MatrixXd& table, int samples,
                             bool normalize) {
  require(table.rows() >= 2, "rows of the target", table.rows(), "must be >= 2");
  require(table.cols() >= 1, "columns of the target", table.cols(), "must be >= 1");
  require(samples >= 8, "samples", samples, "must be >= 8");
  constexpr double largest = 1e100;  // avoids overflow and underflow of squares
  TargetSet set{std::move(name), {}};
  for (Eigen::Index k = 0; k < table.cols(); ++k) {
    Eigen::VectorXd column = table.col(k);
    for (Eigen::Index n = 0; n < column.size(); ++n)
      require(std::abs(column[n]) <= largest, fmt::format("target[{}, {}]", n, k), column[n],
              "must be finite and at most 1e100");
    require(column.cwiseAbs().maxCoeff() >= 1.0 / largest, fmt::format("target column {}", k),
            column.cwiseAbs().maxCoeff(), "must have values of at least 1e-100");
    if (normalize) {
      const double low = column.minCoeff(), high = column.maxCoeff();
      require(high > low, fmt::format("target column {}", k), low,
              "is constant and cannot be rescaled to [0, 1]");
      column = (column.array() - low) / (high - low);
    }
    Eigen::VectorXd bins(samples);
    for (int n = 0; n < samples; ++n) {
      const double position = static_cast<double>(n) * static_cast<double>(column.size()) / samples;
      const auto before = static_cast<Eigen::Index>(position);
      const double share = position - static_cast<double>(before);
      bins[n] = (1.0 - share) * column[before] + share * column[(before + 1) % column.size()];
    }
    const double mean = bins.mean();
    set.measurements.push_back({std::move(bins), mean, std::nullopt});
  }
  return set;
}

}  // namespace tofsmith
