// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/ambient_projection.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "core/shared/random.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {
namespace {

DecodingTable table_of(const std::string& code, double peak_factor) {
  Camera camera = built_in_camera("paper-10f0");
  camera.light.peak_factor = peak_factor;
  return make_decoding_table(ForwardModel(build_family(code, camera), camera), camera);
}

DecodingTable rounded_otherwise(DecodingTable table) {
  RandomStream random(1, 0, 0);
  for (double& value : table.correlation.reshaped()) value *= 1.0 + 4e-16 * random.normal();
  return table;
}

// These curves are equally long in two directions of their space.
TEST(AmbientProjection, BasisOfTiedDirectionsIsRobustToRounding) {
  for (const auto& [code, peak] : {std::pair{"sinusoid-k4", 15.0},
                                   {"square-k4", 15.0},
                                   {"hamiltonian-k4", 6.0},
                                   {"hamiltonian-k4", 15.0},
                                   {"multifrequency-k5", 15.0}}) {
    SCOPED_TRACE(code);
    const DecodingTable table = table_of(code, peak);
    const AmbientProjection one(table), other(rounded_otherwise(table));
    ASSERT_EQ(one.rank(), other.rank());
    EXPECT_LT((one.noise_basis - other.noise_basis).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(AmbientProjection, BasisIsOrthonormalAndSpansTheCurve) {
  for (const char* code : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k5"}) {
    SCOPED_TRACE(code);
    const AmbientProjection projection(table_of(code, 6.0));
    const Eigen::MatrixXd& v = projection.noise_basis;
    EXPECT_TRUE((v.transpose() * v).isIdentity(1e-12));
    EXPECT_LT((v.transpose() * projection.ambient).norm(), 1e-15 * projection.ambient.norm());
    const Eigen::VectorXd a = projection.ambient.normalized();
    const Eigen::MatrixXd across = projection.gated - (projection.gated * a) * a.transpose();
    EXPECT_LT((across - projection.curve * v.transpose()).norm(), 1e-12 * across.norm());
  }
}

}  // namespace
}  // namespace tofsmith
