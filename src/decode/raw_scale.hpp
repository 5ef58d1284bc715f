// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Converts raw values to electrons without dark electrons, and back.
class RawScale {
 public:
  explicit RawScale(const DecodingTable& table) {
    for (int k = 0; k < table.measurements(); ++k) {
      const double gain_e_per_raw = table.gain_e_per_raw[k];
      lines_.push_back(
          {table.black_level[k] + table.dark_electrons[k] / gain_e_per_raw, gain_e_per_raw});
    }
  }

  double electrons(double raw, int measurement) const {
    const Line& line = lines_[static_cast<std::size_t>(measurement)];
    return (raw - line.dark_raw) * line.gain_e_per_raw;
  }
  /// Converts the raw values of a pixel. Returns false if one is NaN or infinite.
  bool read(const float* raw, double* pixel_electrons) const {
    bool is_finite = true;
    for (int k = 0; k < static_cast<int>(lines_.size()); ++k) {
      pixel_electrons[k] = electrons(static_cast<double>(raw[k]), k);
      is_finite = is_finite && std::isfinite(raw[k]);
    }
    return is_finite;
  }
  double dark_raw(int measurement) const {
    return lines_[static_cast<std::size_t>(measurement)].dark_raw;
  }
  double gain_e_per_raw(int measurement) const {
    return lines_[static_cast<std::size_t>(measurement)].gain_e_per_raw;
  }
  double raw(double electrons, int measurement) const {
    const Line& line = lines_[static_cast<std::size_t>(measurement)];
    return electrons / line.gain_e_per_raw + line.dark_raw;
  }

 private:
  struct Line {
    double dark_raw;
    double gain_e_per_raw;
  };
  std::vector<Line> lines_;
};

}  // namespace tofsmith
