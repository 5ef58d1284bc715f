// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/decoding_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "decode_setup.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

DecodingTable good_table() {
  return decoding_table_of("hamiltonian-k4", camera_with("paper-10f0"));
}

template <typename Change>
std::string complaint(const Change& change) {
  DecodingTable table = good_table();
  change(table);
  try {
    table.validate();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DecodingTable, RejectsInvalidTablesByName) {
  const double nan = std::nan("");
  EXPECT_EQ(complaint([](DecodingTable&) {}), "accepted");
  EXPECT_EQ(complaint([&](DecodingTable& t) { t.correlation(7, 2) = nan; }),
            "correlation = NaN or infinite; must be finite");
  EXPECT_EQ(complaint([&](DecodingTable& t) { t.ambient_gain[1] = nan; }),
            "ambient_gain = nan; must be finite");
  EXPECT_EQ(complaint([](DecodingTable& t) { t.exposure_s.conservativeResize(3); }),
            "exposure_s = 3 entries; must have one for each of the 4 measurements");
  EXPECT_EQ(complaint([](DecodingTable& t) { t.exposure_s[0] = 0.0; }),
            "exposure_s = 0; must be > 0");
  EXPECT_EQ(complaint([](DecodingTable& t) { t.constant_variance_e2[3] = -1.0; }),
            "constant_variance_e2 = -1; must not be negative");
  EXPECT_EQ(complaint([](DecodingTable& t) { t.shot_correlation = Eigen::MatrixXd::Ones(2, 4); }),
            "shot_correlation = 2 x 4; must have the shape of correlation, 240 x 4");
  EXPECT_EQ(complaint([](DecodingTable& t) { t.range_m = 0.0; }),
            "range_m = 0; must be finite and > 0");
  EXPECT_EQ(complaint([](DecodingTable& t) { t.gain_e_per_raw[2] = -2.0; }),
            "gain_e_per_raw = -2; must not be negative");
}

TEST(DecodingTable, RequiresACurveOfTwoDimensions) {
  const Eigen::VectorXd wave = Eigen::VectorXd::LinSpaced(60, 0.0, 1.0);
  Eigen::MatrixXd two(60, 2), line(60, 3);
  two << wave, wave.reverse();
  line << wave, wave, -wave;
  EXPECT_THAT([&] { make_decoding_table(two, 10.0).validate(); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("must be >= 3")));
  EXPECT_THAT([&] { make_decoding_table(line, 10.0).validate(); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("rank")));
  EXPECT_THAT([&] { make_decoding_table(Eigen::MatrixXd::Ones(60, 4), 10.0).validate(); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("rank")));
  EXPECT_THROW(make_decoding_table(Eigen::MatrixXd(), 10.0).validate(), std::invalid_argument);
}

TEST(WhyNotDecodable, ReturnsTheMessagesOfTheChecks) {
  const auto flatten = [](DecodingTable& table) { table.correlation.setConstant(0.25); };
  DecodingTable flat = good_table();
  flatten(flat);
  EXPECT_EQ(why_not_decodable(good_table()), std::nullopt);
  EXPECT_EQ(why_not_decodable(flat), complaint(flatten));
  EXPECT_EQ(TwoReturnDecoder::why_not_decodable(flat), complaint(flatten));

  // Four phase steps determine depth but not a second return.
  const std::optional<std::string> why_one = TwoReturnDecoder::why_not_decodable(good_table());
  ASSERT_TRUE(why_one.has_value());
  try {
    const TwoReturnDecoder decoder(good_table());
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_EQ(*why_one, error.what());
  }
}

TEST(DecodingTable, FollowsTheForwardModel) {
  Camera camera = camera_with("paper-10f0", 2, Readout::difference);
  camera.sensor.dark_current_e_per_s = 40.0;
  const ForwardModel model(build_family("hamiltonian-k4", camera), camera);
  const DecodingTable table = make_decoding_table(model, camera);
  const Return r{2e4, 50.0};
  const Eigen::VectorXd light =
      2e4 * table.shot_correlation.row(50).transpose() + 3e3 * table.shot_ambient_gain;
  const Eigen::VectorXd variance =
      light.cwiseProduct(table.exposure_s) + table.shot_dark_electrons + table.constant_variance_e2;
  EXPECT_LT((variance - model.variance_e2({&r, 1}, 3e3)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(DecodingTable, ContainsTheLimitsOfRawValues) {
  Camera camera = camera_with("paper-10f0");
  const auto level = [&] { return decoding_table_of("hamiltonian-k3", camera).saturation_level; };
  EXPECT_FALSE(level().has_value());
  camera.sensor.full_well_e = 30000.0;
  EXPECT_EQ(level(), 30000.0f);
  camera.sensor.adc_bits = 12;
  camera.sensor.gain_e_per_dn = 10.0;
  camera.sensor.black_level_dn = 100.0;
  EXPECT_EQ(level(), 3100.0f);
  camera.sensor.full_well_e = 1e6;
  EXPECT_EQ(level(), 4095.0f);
}

TEST(AmbiguousDepths, AreReportedInBinsAndMetres) {
  // Two periods in the range: each depth of the second half equals a depth of the first.
  Eigen::MatrixXd twice(40, 3);
  for (int n = 0; n < 40; ++n)
    for (int k = 0; k < 3; ++k) twice(n, k) = 0.5 + 0.5 * std::cos(M_PI * (n / 10.0 - 2 * k / 3.0));
  const std::vector<AmbiguousDepths> found = ambiguous_depths(make_decoding_table(twice, 8.0));
  ASSERT_EQ(found.size(), 20u);
  for (int n = 0; n < 20; ++n) {
    const AmbiguousDepths& pair = found[static_cast<std::size_t>(n)];
    EXPECT_EQ(pair.first_bin, n);
    EXPECT_EQ(pair.second_bin, n + 20);
    EXPECT_NEAR(pair.second_m - pair.first_m, 4.0, 1e-12);
  }
}

TEST(AmbiguousDepths, AreNoneInGoodCodes) {
  EXPECT_TRUE(ambiguous_depths(good_table()).empty());
  const Camera camera = camera_with("paper-30x");
  for (const char* code :
       {"sinusoid-k3", "sinusoid-k4", "square-k3", "square-k4", "hamiltonian-k3", "hamiltonian-k4",
        "hamiltonian-k5", "hamiltonian-k6", "multifrequency-k5", "pulsed-multifrequency-k5"})
    EXPECT_TRUE(ambiguous_depths(decoding_table_of(code, camera)).empty()) << code;
}

TEST(AmbiguousDepths, ExcludeDepthsWithoutContrast) {
  // Gray words of all zeros and all ones resemble ambient light, not each other.
  const DecodingTable table = decoding_table_of("gray-k4", camera_with("paper-30x"));
  const Eigen::VectorXd contrast =
      table.correlation.rowwise().maxCoeff() - table.correlation.rowwise().minCoeff();
  EXPECT_LT(contrast.minCoeff(), 1e-9);
  for (const AmbiguousDepths& pair : ambiguous_depths(table))
    EXPECT_GT(contrast[pair.first_bin], 1e-9);
}

}  // namespace
}  // namespace tofsmith
