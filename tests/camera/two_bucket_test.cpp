// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Two-bucket sensors: every exposure is read out twice, d and 1 - d.
#include <gtest/gtest.h>

#include <algorithm>

#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {
namespace {

struct TwoBucketCase {
  std::string code;
  int exposures;
  int samples;
};

class TwoBuckets : public testing::TestWithParam<TwoBucketCase> {
 protected:
  Camera camera(const char* name) const {
    Camera camera = built_in_camera(name);
    camera.samples = GetParam().samples;
    camera.sensor.taps = 2;
    return camera;
  }
};

TEST_P(TwoBuckets, ExposuresShareTheTimeAndGiveTwoValuesEach) {
  const Camera camera = this->camera("paper-10f0");
  const CodeSet code = build_family(GetParam().code, camera);
  const ForwardModel model(code, camera);
  EXPECT_EQ(code.exposures(), GetParam().exposures);
  EXPECT_EQ(model.measurements(), 2 * GetParam().exposures);
  for (const double exposure_s : model.exposure_s())
    EXPECT_DOUBLE_EQ(exposure_s, camera.exposure_s.total_s / GetParam().exposures);
  // Every readout has its own read noise.
  for (const double variance : model.constant_variance_e2()) EXPECT_DOUBLE_EQ(variance, 400.0);
}

TEST_P(TwoBuckets, ABucketAndItsComplementContainAllLight) {
  for (const char* name : {"paper-30x", "paper-10f0", "paper-5f0"})
    for (const double contrast : {1.0, 0.6})
      for (const double dark : {0.0, 3e3}) {
        Camera camera = this->camera(name);
        camera.sensor.modulation_contrast = contrast;
        camera.sensor.dark_current_e_per_s = dark;
        const CodeSet code = build_family(GetParam().code, camera);
        const ForwardModel model(code, camera);
        const double S = 2e4, A = 3e3, T = camera.exposure_s.total_s / code.exposures();
        for (const double depth_bin : {0.0, 33.7, 0.71 * camera.samples}) {
          const Return r{S, depth_bin};
          const Eigen::VectorXd mean = model.expected_electrons({&r, 1}, A);
          const Eigen::VectorXd variance = model.variance_e2({&r, 1}, A);
          for (int e = 0; e < code.exposures(); ++e) {
            const double all_e = T * (S * code.modulation(e).mean() + A + 2 * dark);
            EXPECT_NEAR(mean[2 * e] + mean[2 * e + 1], all_e, 1e-9 * all_e);
            EXPECT_NEAR(variance[2 * e] + variance[2 * e + 1], all_e + 2 * 400.0, 1e-9 * all_e);
          }
        }
      }
}

TEST_P(TwoBuckets, TheSecondBucketIsOneMinusTheFirst) {
  const Camera camera = this->camera("paper-5f0");
  Camera one_tap = camera;
  one_tap.sensor.taps = 1;
  const Eigen::MatrixXd both =
      ForwardModel(build_family(GetParam().code, camera), camera).correlation_table(480);
  const Eigen::MatrixXd first =
      ForwardModel(build_family(GetParam().code, one_tap), one_tap).correlation_table(480);
  for (Eigen::Index e = 0; e < first.cols(); ++e) {
    EXPECT_LT((both.col(2 * e) - first.col(e)).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((both.col(2 * e + 1).array() - 1.0 + first.col(e).array()).abs().maxCoeff(), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Codes, TwoBuckets,
                         testing::Values(TwoBucketCase{"hamiltonian-k4", 4, 240},
                                         TwoBucketCase{"hamiltonian-k5", 5, 240},
                                         TwoBucketCase{"hamiltonian-k6", 6, 240},
                                         TwoBucketCase{"hamiltonian-k7", 7, 252},
                                         TwoBucketCase{"hamiltonian-k8", 8, 252},
                                         TwoBucketCase{"sinusoid-k4", 4, 240},
                                         TwoBucketCase{"multifrequency-1x4-7x4", 8, 240},
                                         TwoBucketCase{"pulsed-multifrequency-k4", 4, 240}),
                         [](const auto& info) {
                           std::string name = info.param.code;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(TwoBucketFamilies, BuildALongWalkOnFewSamples) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = 2;
  EXPECT_EQ(build_family("hamiltonian-k7", camera).samples(), camera.samples);
}

}  // namespace
}  // namespace tofsmith
