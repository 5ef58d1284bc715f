// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "likelihood_setup.hpp"
#include "pixel_laws.hpp"

namespace tofsmith {
namespace {

TEST(LikelihoodDecoder, StrongSignalIsOk) {
  expect_strong_signal_is_ok(LikelihoodSetup("hamiltonian-k4", camera_with("paper-10f0")), 1e5,
                             100.0, 100.0);
}

TEST(LikelihoodDecoder, NaNIsInvalidAndDoesNotAffectNeighbours) {
  expect_not_a_number_disturbs_no_neighbour(
      LikelihoodSetup("hamiltonian-k4", camera_with("paper-10f0")).decoder, 20);
}

TEST(LikelihoodDecoder, BadPixelsHaveTheSameStatusAsWithZncc) {
  Camera camera = camera_with("paper-10f0");
  camera.sensor.full_well_e = 5000.0;
  const LikelihoodSetup setup("hamiltonian-k4", camera);
  const Decoder zncc(setup.decoder.table());
  std::vector<float> faint, ambient_alone(4, 700.0f);
  setup.append_expected(faint, 50.0, 30.0, 1e4);
  for (const auto& [raw, status] :
       {std::pair{faint, PixelStatus::low_signal}, std::pair{ambient_alone, PixelStatus::no_return},
        std::pair{std::vector<float>(4, 0.0f), PixelStatus::no_return},
        std::pair{std::vector<float>(4, 5000.0f), PixelStatus::saturated},
        std::pair{std::vector<float>{1, not_a_number, 1, 5000.0f}, PixelStatus::invalid}}) {
    const DepthImage image = decode_pixels(setup.decoder, raw);
    EXPECT_EQ(image.status(0, 0), status) << name_of(status);
    EXPECT_EQ(image.status(0, 0), zncc.decode(frame_of(raw, 4)).status(0, 0));
    EXPECT_EQ(std::isnan(image.depth_m(0, 0)), status != PixelStatus::low_signal);
  }
}

TEST(LikelihoodDecoder, NegativeSignalIsNoReturn) {
  expect_negative_signal_is_no_return<LikelihoodDecoder>();
}

TEST(LikelihoodDecoder, HugeValuesDoNotOverflow) {
  expect_huge_numbers_are_decoded(LikelihoodSetup("hamiltonian-k3", camera_with("paper-30x")));
}

struct NoiseCase {
  const char* code;
  int taps = 1;
  Readout readout = Readout::separate;
  std::vector<double> exposure_s;
};

class LikelihoodEstimatesOf : public testing::TestWithParam<NoiseCase> {};

TEST_P(LikelihoodEstimatesOf, AgreeWithMonteCarloAtHighSignal) {
  const NoiseCase& c = GetParam();
  Camera camera = camera_with("paper-10f0", c.taps, c.readout);
  camera.exposure_s.each_s = c.exposure_s;
  const LikelihoodSetup setup(c.code, camera);
  for (const double truth_bin : {33.3, 121.7, 200.2})
    EXPECT_NEAR(estimates_at(setup, truth_bin, 1e6, 1e5).ratio(), 1.0, 4 * 0.0112)
        << c.code << " at " << truth_bin;
}

INSTANTIATE_TEST_SUITE_P(
    Codes, LikelihoodEstimatesOf,
    testing::Values(NoiseCase{"sinusoid-k4"}, NoiseCase{"hamiltonian-k4"},
                    NoiseCase{
                        "hamiltonian-k5", 1, Readout::separate, {0.01, 0.02, 0.05, 0.08, 0.14}},
                    NoiseCase{"hamiltonian-k4", 2}));

TEST(LikelihoodDecoder, ConfidenceIsTheFractionOfCorrectDepths) {
  const LikelihoodSetup setup("hamiltonian-k5", camera_with("paper-30x"));
  expect_right_as_often_as_said(setup, {1.25e2, 2.5e2, 5e2, 1e3, 2e3, 4e3, 8e3}, 3e3, 0.06);
}

}  // namespace
}  // namespace tofsmith
