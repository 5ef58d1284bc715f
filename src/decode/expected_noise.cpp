// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/expected_noise.hpp"

namespace tofsmith {

namespace {

const Eigen::MatrixXd& or_else(const Eigen::MatrixXd& given, const Eigen::MatrixXd& otherwise) {
  return given.size() > 0 ? given : otherwise;
}
const Eigen::VectorXd& or_else(const Eigen::VectorXd& given, const Eigen::VectorXd& otherwise) {
  return given.size() > 0 ? given : otherwise;
}

}  // namespace

ExpectedNoise::ExpectedNoise(const DecodingTable& table)
    : shot_gated(or_else(table.shot_correlation, table.correlation) *
                 table.exposure_s.asDiagonal()),
      shot_ambient(
          or_else(table.shot_ambient_gain, table.ambient_gain).cwiseProduct(table.exposure_s)),
      floor_variance_e2(or_else(table.shot_dark_electrons, table.dark_electrons) +
                        table.constant_variance_e2) {}

}  // namespace tofsmith
