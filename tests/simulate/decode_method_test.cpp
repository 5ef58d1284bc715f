// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {
namespace {

Estimate error_of(const char* code, const char* camera_name, OperatingPoint point,
                  DecodeMethod method, UnwrapWeights weights = UnwrapWeights::variance) {
  Camera camera = built_in_camera(camera_name);
  camera.operating.signal_e_per_s = {point.signal_e_per_s};
  camera.operating.ambient_e_per_s = {point.ambient_e_per_s};
  return evaluate(build_family(code, camera), camera,
                  {.trials = 20000,
                   .method = method,
                   .unwrap_weights = weights,
                   .draw_every_measurement = true})
      .points[0]
      .circular_mde_m;
}

double ratio_of(const char* camera, OperatingPoint point, UnwrapWeights weights) {
  return error_of("multifrequency-k5", camera, point, DecodeMethod::unwrap, weights).value /
         error_of("multifrequency-k5", camera, point, DecodeMethod::zncc).value;
}

TEST(DecodeMethods, AgreeOnASingleFrequency) {
  for (const double signal : {1e3, 1e5}) {
    const OperatingPoint point{signal, 1e4};
    const double zncc = error_of("sinusoid-k4", "paper-10f0", point, DecodeMethod::zncc).value;
    const double unwrap = error_of("sinusoid-k4", "paper-10f0", point, DecodeMethod::unwrap).value;
    EXPECT_NEAR(unwrap / zncc, 1.0, 1e-4);
  }
}

TEST(DecodeMethods, ZnccBeatsClassicalUnwrappingInLowLight) {
  // Both decode the same noise, so that ratios are far more precise than errors.
  const OperatingPoint low{3162.3, 1e3};
  EXPECT_GT(ratio_of("paper-30x", low, UnwrapWeights::frequency), 1.0);
  EXPECT_GT(ratio_of("paper-10f0", low, UnwrapWeights::frequency), 1.02);
  EXPECT_GT(ratio_of("paper-5f0", low, UnwrapWeights::frequency), 1.1);
}

TEST(DecodeMethods, WeightsByVarianceAreNoWorseThanClassicalOnes) {
  for (const char* camera : {"paper-30x", "paper-10f0", "paper-5f0"})
    for (const OperatingPoint point : {OperatingPoint{3162.3, 1e3}, OperatingPoint{1e5, 1e4}})
      EXPECT_LT(ratio_of(camera, point, UnwrapWeights::variance),
                1.005 * ratio_of(camera, point, UnwrapWeights::frequency))
          << camera;
}

TEST(DecodeMethods, UnwrappingIsNearlyAsGoodAtHighLightWithoutABandLimit) {
  for (const UnwrapWeights weights : {UnwrapWeights::variance, UnwrapWeights::frequency})
    EXPECT_NEAR(ratio_of("paper-30x", {1e5, 1e2}, weights), 1.0, 0.08) << name_of(weights);
}

TEST(DecodeMethods, FrequencyWeightsCostMoreUnderABandLimit) {
  const double by_variance = ratio_of("paper-10f0", {1e5, 1e2}, UnwrapWeights::variance);
  const double by_frequency = ratio_of("paper-10f0", {1e5, 1e2}, UnwrapWeights::frequency);
  EXPECT_GT(by_frequency, 1.1);
  EXPECT_LT(by_variance, by_frequency);
}

TEST(DecodeMethods, UnsuitableCodesAreRejected) {
  const Camera camera = built_in_camera("paper-10f0");
  EXPECT_THROW(evaluate(build_family("hamiltonian-k3", camera), camera,
                        {.trials = 100, .method = DecodeMethod::unwrap}),
               std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
