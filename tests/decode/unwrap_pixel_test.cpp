// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "pixel_laws.hpp"
#include "tofsmith/decode/decode_method.hpp"
#include "unwrap_setup.hpp"

namespace tofsmith {
namespace {

TEST(UnwrapDecoder, StrongSignalIsOk) {
  expect_strong_signal_is_ok(UnwrapSetup("multifrequency-k5", camera_with("paper-10f0")), 1e6, 2e3,
                             1e3);
}

TEST(UnwrapDecoder, NaNIsInvalidAndDoesNotAffectNeighbours) {
  expect_not_a_number_disturbs_no_neighbour(
      UnwrapSetup("multifrequency-k5", camera_with("paper-10f0")).decoder, 20);
}

TEST(UnwrapDecoder, StatusFollowsTheSameRulesAsWithZncc) {
  Camera camera = camera_with("paper-10f0");
  camera.sensor.full_well_e = 5000.0;
  const UnwrapSetup setup("multifrequency-k5", camera);
  EXPECT_EQ(decode_pixels(setup.decoder, std::vector<float>(5, 700.0f)).status(0, 0),
            PixelStatus::no_return);
  EXPECT_EQ(decode_pixels(setup.decoder, std::vector<float>(5, 5000.0f)).status(0, 0),
            PixelStatus::saturated);
  std::vector<float> faint;
  setup.append_expected(faint, 50.0, 30.0, 1e4);
  EXPECT_EQ(decode_pixels(setup.decoder, faint).status(0, 0), PixelStatus::low_signal);
  RawFrames wrong = frame_of(std::vector<float>(8, 1.0f), 4);
  EXPECT_THROW(setup.decoder.decode(wrong), std::invalid_argument);
}

struct NoiseCase {
  const char* code;
  const char* camera;
  int taps;
  Readout readout;
  UnwrapWeights weights;
};

class UnwrapEstimatesOf : public testing::TestWithParam<NoiseCase> {};

TEST_P(UnwrapEstimatesOf, AgreeWithMonteCarloAtHighSignal) {
  const NoiseCase c = GetParam();
  const UnwrapSetup setup(c.code, camera_with(c.camera, c.taps, c.readout), {.weights = c.weights});
  for (const double truth_bin : {33.3, 121.7, 200.2})
    EXPECT_NEAR(estimates_at(setup, truth_bin, 1e6, 1e4).ratio(), 1.0, 0.06)
        << c.code << " at " << truth_bin;
}

INSTANTIATE_TEST_SUITE_P(Codes, UnwrapEstimatesOf,
                         testing::Values(NoiseCase{"sinusoid-k4", "paper-10f0", 1,
                                                   Readout::separate, UnwrapWeights::variance},
                                         NoiseCase{"multifrequency-k5", "paper-30x", 1,
                                                   Readout::separate, UnwrapWeights::variance},
                                         NoiseCase{"multifrequency-k5", "paper-10f0", 1,
                                                   Readout::separate, UnwrapWeights::frequency},
                                         NoiseCase{"multifrequency-1x4-7x4", "paper-10f0", 2,
                                                   Readout::separate, UnwrapWeights::variance},
                                         NoiseCase{"multifrequency-1x3-5x3", "paper-10f0", 2,
                                                   Readout::difference, UnwrapWeights::variance}));

TEST(UnwrapDecoder, ConfidenceIsTheFractionOfCorrectDepths) {
  const UnwrapSetup setup("multifrequency-k5", camera_with("paper-30x"));
  expect_right_as_often_as_said(setup, {3e2, 6e2, 1.25e3, 2.5e3, 5e3, 1e4, 2e4}, 3e4, 0.08);
}

TEST(DecodeMethod, HasAName) {
  for (const DecodeMethod method : all_decode_methods)
    EXPECT_EQ(parse_decode_method(name_of(method)), method);
  for (const UnwrapWeights weights : {UnwrapWeights::variance, UnwrapWeights::frequency})
    EXPECT_EQ(parse_unwrap_weights(name_of(weights)), weights);
  EXPECT_THROW(parse_decode_method("magic"), std::invalid_argument);
  EXPECT_THROW(parse_unwrap_weights("magic"), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
