// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// From raw numbers to electrons without dark ones.
class RawScale {
 public:
  explicit RawScale(const DecodingTable& table) : gain_e_per_raw_(table.gain_e_per_raw) {
    for (const double dark_e : table.dark_electrons)
      dark_raw_.push_back(table.black_level + dark_e / table.gain_e_per_raw);
  }

  double electrons(double raw, int measurement) const {
    return (raw - dark_raw_[static_cast<std::size_t>(measurement)]) * gain_e_per_raw_;
  }

 private:
  std::vector<double> dark_raw_;  // raw number of every measurement without light
  double gain_e_per_raw_;
};

}  // namespace tofsmith
