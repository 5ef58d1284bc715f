// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/expected_noise.hpp"

namespace tofsmith {

ExpectedNoise::ExpectedNoise(const DecodingTable& table)
    : shot_gated(table.shot() * table.exposure_s.asDiagonal()),
      shot_ambient(table.shot_ambient().cwiseProduct(table.exposure_s)),
      floor_variance_e2(table.shot_dark() + table.constant_variance_e2) {
  if (table.ambient_gain.isZero(0.0))
    floor_variance_e2 += table.hidden_ambient_e_per_s * shot_ambient;
}

}  // namespace tofsmith
