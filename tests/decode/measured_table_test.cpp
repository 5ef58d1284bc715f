// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/decoding_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "decode_setup.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

MeasuredTable sweep_of(const ForwardModel& model, const Camera& camera) {
  MeasuredTable measured;
  measured.correlation = model.tap_correlation_table(model.samples());
  measured.taps = camera.sensor.taps;
  measured.ambient_gain = ambient_gain_of(measured.correlation, MeasuredAmbient::mean);
  return measured;
}

DepthImage decoded(const DecodingTable& table, const RawFrames& raw, FilteredFrame& filtered,
                   FilterStrength strength) {
  Filter(table, FilterOptions::of(strength)).apply(view_of_frame(raw, 0), filtered);
  return decode_filtered(Decoder(table), filtered);
}

/// Expects the same conversion, exposures, constant noise and bins.
void expect_same_decoding(const DecodingTable& table, const DecodingTable& code, double ambient) {
  EXPECT_TRUE(table.correlation.isApprox(code.correlation, 1e-12));
  EXPECT_EQ(table.exposure_s, code.exposure_s);
  EXPECT_EQ(table.gain_e_per_raw, code.gain_e_per_raw);
  EXPECT_EQ(table.black_level, code.black_level);
  EXPECT_LT((table.dark_electrons - code.dark_electrons).norm(), 1e-9);
  EXPECT_TRUE(table.constant_variance_e2.isApprox(code.constant_variance_e2, 1e-12));
  const std::vector<float> raw = noisy_pixels(code, 3e4, ambient, 2000, 8);
  EXPECT_EQ(bins_of(Decoder(table), raw), bins_of(Decoder(code), raw));
}

TEST(MeasuredTable, ASweepOfACodeDecodesLikeTheCode) {
  for (const Readout readout : {Readout::separate, Readout::difference}) {
    Camera camera = camera_with("paper-10f0", 2, readout);
    camera.sensor.dark_current_e_per_s = 300.0;
    camera.sensor.full_well_e = 50000.0;
    camera.sensor.adc_bits = 12;
    camera.sensor.gain_e_per_dn = 10.0;
    camera.sensor.black_level_dn = 30.0;
    camera.exposure_s.each_s = {0.05, 0.1, 0.15};
    const ForwardModel model(build_family("hamiltonian-k3", camera), camera);
    const DecodingTable code = make_decoding_table(model, camera);
    const DecodingTable table = make_decoding_table(sweep_of(model, camera), camera);
    expect_same_decoding(table, code, 1e4);
    EXPECT_LT((table.ambient_gain - code.ambient_gain).norm(), 1e-9);
    EXPECT_EQ(table.saturation_level, code.saturation_level);
    EXPECT_EQ(table.range_m, code.range_m);
    EXPECT_EQ(table.shot_correlation.size(), code.shot_correlation.size());
    EXPECT_TRUE(table.shot().isApprox(code.shot(), 1e-9));
    EXPECT_TRUE(table.shot_ambient().isApprox(code.shot_ambient(), 1e-9));
    EXPECT_TRUE(table.shot_dark().isApprox(code.shot_dark(), 1e-9));
  }
}

TEST(MeasuredTable, ASweepOfAMixerDecodesLikeItsCode) {
  Camera camera = camera_with("paper-10f0");
  camera.sensor.demodulation = Demodulation::weight;
  camera.sensor.dark_current_e_per_s = 300.0;
  camera.sensor.adc_bits = 12;
  camera.sensor.gain_e_per_dn = 10.0;
  camera.sensor.black_level_dn = 2048.0;
  camera.exposure_s.each_s = {0.05, 0.1, 0.15};
  const ForwardModel model(build_family("hamiltonian-k3", camera), camera);
  const DecodingTable code = make_decoding_table(model, camera);
  MeasuredTable measured;
  measured.correlation = model.correlation_table(model.samples());
  EXPECT_LT(measured.correlation.minCoeff(), 0.0);
  EXPECT_THAT([&] { make_decoding_table(measured, camera); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("whose measurements are signed")));
  measured.differences = true;
  const DecodingTable table = make_decoding_table(measured, camera);
  // A mixer has one readout and dark current per number, a difference of buckets has two.
  expect_same_decoding(table, code, 0.0);
  EXPECT_TRUE(table.shot_dark_electrons.isApprox(code.shot_dark_electrons, 1e-9));
  // The shot noise of a signed column is at least that of its absolute value.
  EXPECT_TRUE((table.shot_correlation.array() >= measured.correlation.array().abs() - 1e-12).all());
}

// With separate taps the total light, and thus the noise, does not depend on the omitted constant.
TEST(MeasuredTable, ConstantsAlongAmbientLightChangeNoDepth) {
  const Camera camera = camera_with("paper-10f0");
  const ForwardModel model(build_family("hamiltonian-k4", camera), camera);
  const MeasuredTable measured = sweep_of(model, camera);
  const DecodingTable as_is = make_decoding_table(measured, camera);
  constexpr int side = 32;
  const auto plane = [](int y, int x) { return Seen{55.0 + 0.02 * x + 0.01 * y, 2e3}; };
  const RawFrames raw = frame_seen(as_is, side, side, plane, 1e4, 2);
  for (const double constant : {0.05, 0.5, 3.0}) {
    MeasuredTable lower = measured;
    lower.correlation.rowwise() -= constant * measured.ambient_gain.transpose();
    const DecodingTable shifted = make_decoding_table(lower, camera);
    EXPECT_GE(shifted.shot().minCoeff(), 0.0);
    for (const FilterStrength strength : all_values<FilterStrength>) {
      FilteredFrame of_table, of_lower;
      const DepthImage expected = decoded(as_is, raw, of_table, strength);
      const DepthImage image = decoded(shifted, raw, of_lower, strength);
      for (std::size_t i = 0; i < image.status.pixels.size(); ++i) {
        ASSERT_NEAR(of_lower.averaged().pixels[i] / of_table.averaged().pixels[i], 1.0, 1e-2);
        ASSERT_NEAR(image.depth_m.pixels[i], expected.depth_m.pixels[i], 1e-4);
        ASSERT_NEAR(image.confidence.pixels[i], expected.confidence.pixels[i], 1e-3);
      }
    }
  }
}

TEST(MeasuredTable, ValuesInTheFileOverrideTheCamera) {
  const Camera camera = camera_with("paper-10f0");
  MeasuredTable measured =
      sweep_of(ForwardModel(build_family("hamiltonian-k3", camera), camera), camera);
  measured.ambient_gain = Eigen::Vector3d(0.1, 0.2, 0.3);
  measured.exposure_s = Eigen::Vector3d(1.0, 2.0, 3.0);
  measured.black_level = Eigen::Vector3d(4.0, 5.0, 6.0);
  measured.gain_e_per_raw = Eigen::Vector3d(7.0, 8.0, 9.0);
  const DecodingTable table = make_decoding_table(measured, camera);
  EXPECT_EQ(table.ambient_gain, measured.ambient_gain);
  EXPECT_EQ(table.exposure_s, measured.exposure_s);
  EXPECT_EQ(table.black_level, measured.black_level);
  EXPECT_EQ(table.gain_e_per_raw, measured.gain_e_per_raw);
}

TEST(MeasuredTable, AmbientLightCancelsInDifferencesAndOnRequest) {
  Camera camera = camera_with("paper-10f0", 2, Readout::difference);
  MeasuredTable pairs{Eigen::MatrixXd::Random(40, 6), 2, {}, {}, {}, {}};
  EXPECT_EQ(make_decoding_table(pairs, camera).ambient_gain, Eigen::VectorXd::Zero(3));

  MeasuredTable circle{Eigen::MatrixXd(60, 2), 1, {}, {}, {}, {}};
  for (int n = 0; n < 60; ++n)
    circle.correlation.row(n) << std::cos(M_PI * n / 30), std::sin(M_PI * n / 30);
  circle.ambient_gain = ambient_gain_of(circle.correlation, MeasuredAmbient::none);
  const DecodingTable table = make_decoding_table(circle, camera_with("paper-10f0"));
  EXPECT_EQ(bins_of(Decoder(table), {0.0f, 1.0f, -3.0f, 0.0f}),
            (std::vector<std::int32_t>{15, 30}));
}

TEST(MeasuredTable, DriftIsInMetresForAnyRangeOfTheTable) {
  Camera camera = camera_with("paper-10f0");
  MeasuredTable measured =
      sweep_of(ForwardModel(build_family("hamiltonian-k4", camera), camera), camera);
  const int samples = measured.samples();
  camera.temperature = Temperature{.reference_c = 20.0, .now_c = 20.0};
  for (const double range_m : {2.0, 31.0}) {
    measured.range_m = range_m;
    const DecodingTable cold = make_decoding_table(measured, camera);
    EXPECT_EQ(cold.range_m, range_m);
    // Three bins in ten degrees.
    Camera warm = camera;
    warm.temperature->offset_m_per_c = 0.3 * range_m / samples;
    warm.temperature->now_c = 30.0;
    const DecodingTable moved = make_decoding_table(measured, warm);
    ASSERT_EQ(moved.samples(), cold.samples());
    const int rows = cold.samples(), by = 3 * rows / samples;
    for (int n = 0; n < rows; ++n)
      EXPECT_TRUE(moved.correlation.row(n).isApprox(cold.correlation.row((n + by) % rows), 1e-9));
  }
}

/// Two cosines in quadrature with a fifth harmonic, (rows, 3).
Eigen::MatrixXd band_limited(int rows) {
  Eigen::MatrixXd columns(rows, 3);
  for (int n = 0; n < rows; ++n)
    for (int k = 0; k < 3; ++k) {
      const double phase = 2 * M_PI * (static_cast<double>(n) / rows - k / 3.0);
      columns(n, k) = 2.0 + std::cos(phase) + 0.1 * std::cos(5 * phase + k);
    }
  return columns;
}

Eigen::MatrixXd with_noise(Eigen::MatrixXd columns, double deviation, std::uint64_t seed) {
  RandomStream random(seed, 0);
  for (double& value : columns.reshaped()) value += deviation * random.normal();
  return columns;
}

/// Root mean square error of the table of `correlation` at all of its rows.
double error_of_table(const Eigen::MatrixXd& correlation) {
  const DecodingTable table =
      make_decoding_table({.correlation = correlation}, camera_with("paper-10f0"));
  EXPECT_GT(table.samples(), correlation.rows());
  const Eigen::MatrixXd error = table.correlation - band_limited(table.samples());
  return std::sqrt(error.squaredNorm() / static_cast<double>(error.size()));
}

TEST(MeasuredTable, IsExactBetweenDelaysIfItIsBandLimited) {
  EXPECT_LT(error_of_table(band_limited(40)), 1e-9);
}

TEST(MeasuredTable, HasOnlyTheNoiseOfItsHarmonicsIfItIsBandLimited) {
  constexpr double noise = 0.01;
  constexpr int rows = 120, harmonics = 5;
  // The noise of 11 of 120 coefficients remains, and of a few more if the band limit found is high.
  const double expected = noise * std::sqrt((2.0 * harmonics + 1.0) / rows);
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    EXPECT_LT(error_of_table(with_noise(band_limited(rows), noise, seed)), 1.6 * expected);
}

/// Returns the table of measured columns if ambient light contributes nothing to them.
Eigen::MatrixXd table_of(const Eigen::MatrixXd& columns) {
  return make_decoding_table({.correlation = columns, .ambient_gain = Eigen::Vector3d::Zero()},
                             camera_with("paper-10f0"))
      .correlation;
}

TEST(MeasuredTable, KeepsCornersAndJumpsThatStandOutFromNoise) {
  Eigen::MatrixXd corners(120, 3), jumps(120, 3);
  for (int n = 0; n < 120; ++n)
    for (int k = 0; k < 3; ++k) {
      const int place = (n + 40 * k) % 120;
      corners(n, k) = std::abs(place - 60);
      jumps(n, k) = place;
    }
  for (const double noise : {0.0, 0.01}) {
    const Eigen::MatrixXd measured = with_noise(corners, noise, 3);
    EXPECT_EQ(table_of(measured), measured) << noise;
  }
  for (const double noise : {0.0, 0.1, 1.0}) {
    const Eigen::MatrixXd measured = with_noise(jumps, noise, 3);
    EXPECT_EQ(table_of(measured), measured) << noise;
  }
}

/// Mean absolute error of pixels at random depths [bin].
double mean_error_bin(const DecodingTable& table, const DecodingTable& truth, double signal) {
  constexpr int pixels = 20000;
  std::vector<float> raw;
  std::vector<double> depth_bin;
  RandomStream random(7, 0);
  for (int p = 0; p < pixels; ++p) {
    depth_bin.push_back(truth.bin_count() * random.uniform());
    append_noisy_pixel(truth, signal, 0.0, depth_bin.back(), random, raw);
  }
  const std::vector<double> found = depth_bins_of(Decoder(table), raw);
  double sum = 0.0;
  for (std::size_t p = 0; p < found.size(); ++p)
    sum += std::abs(std::remainder(found[p] * truth.bin_count() / table.bin_count() - depth_bin[p],
                                   truth.bin_count()));
  return sum / pixels;
}

TEST(MeasuredTable, WithOneHundredTwentyDelaysDecodesLikeTheCode) {
  const Camera camera = camera_with("paper-10f0");
  const ForwardModel model(build_family("hamiltonian-k5", camera), camera);
  const DecodingTable code = make_decoding_table(model, camera);
  for (const double electrons : {3e4, 4e6}) {
    // The mean of 64 pixels with the same light.
    MeasuredTable measured{.correlation = electrons * model.correlation_table(120)};
    RandomStream random(5, 0);
    for (double& value : measured.correlation.reshaped())
      value += std::sqrt(std::max(value, 0.0) / 64) * random.normal();
    measured.correlation /= electrons;
    const double signal = electrons / code.exposure_s[0];
    EXPECT_LT(mean_error_bin(make_decoding_table(measured, camera), code, signal),
              1.02 * mean_error_bin(code, code, signal))
        << electrons;
  }
}

TEST(MeasuredTable, SignedColumnsWithoutAmbientGainAreRaisedByTheirMinimum) {
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Constant(10, 3, 0.25);
  correlation(4, 1) = -2.0;
  correlation(5, 2) = 0.5;
  MeasuredTable measured{correlation, 1, {}, {}, {}, {}};
  const DecodingTable raised = make_decoding_table(measured, camera_with("paper-10f0"));
  EXPECT_EQ(raised.shot(), (correlation.array() + 2.0).matrix());

  // Ambient light cannot raise the second column.
  measured.ambient_gain = Eigen::Vector3d(0.0, 0.0, 1.0);
  measured.correlation(0, 2) = -0.5;
  const DecodingTable partly = make_decoding_table(measured, camera_with("paper-10f0"));
  EXPECT_EQ(partly.shot().col(1), Eigen::VectorXd::Constant(10, 2.0));
  EXPECT_EQ(partly.shot().col(2), (measured.correlation.col(2).array() + 0.5).matrix());

  measured.ambient_gain = Eigen::Vector3d(-1.0, 1.0, 1.0);
  EXPECT_EQ(make_decoding_table(measured, camera_with("paper-10f0")).correlation,
            measured.correlation);

  measured.correlation = correlation;
  measured.ambient_gain = Eigen::VectorXd::Zero(3);
  const DecodingTable table = make_decoding_table(measured, camera_with("paper-10f0"));
  EXPECT_EQ(table.shot().col(0), correlation.col(0));
  EXPECT_EQ(table.shot().col(1), Eigen::VectorXd::Constant(10, 2.0));
  EXPECT_EQ(table.shot().col(2), correlation.col(2));
}

std::string refusal(const std::function<void(MeasuredTable&, Camera&)>& change) {
  Camera camera = camera_with("paper-10f0", 2, Readout::difference);
  MeasuredTable measured{Eigen::MatrixXd::Random(40, 6), 2, {}, {}, {}, {}};
  change(measured, camera);
  try {
    make_decoding_table(measured, camera).validate();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MeasuredTable, RejectsInvalidInputsByName) {
  EXPECT_EQ(refusal([](MeasuredTable&, Camera&) {}), "accepted");
  EXPECT_EQ(refusal([](MeasuredTable& t, Camera&) { t.taps = 1; }),
            "taps of the measured table = 1; must be 2 if the camera reads differences");
  EXPECT_EQ(refusal([](MeasuredTable& t, Camera&) { t.range_m = 0.0; }),
            "range_m = 0; must be finite and > 0");
  EXPECT_EQ(refusal([](MeasuredTable& t, Camera&) { t.taps = 4; }),
            "columns of the measured table = 6; must be a multiple of taps = 4");
  EXPECT_EQ(refusal([](MeasuredTable& t, Camera&) { t.ambient_gain.setOnes(3); }),
            "ambient_gain = 3 entries; must have one for each of the 6 columns");
  EXPECT_EQ(refusal([](MeasuredTable& t, Camera&) {
              t.gain_e_per_raw.setOnes(6);
              t.gain_e_per_raw[3] = 2.0;
            }),
            "gain_e_per_raw = 2; must be equal for both taps if their difference is read out");
  EXPECT_EQ(refusal([](MeasuredTable&, Camera& c) {
              c.exposure_s.each_s = {0.1, 0.2};
            }),
            "exposure_s = 2 entries; must be one number or one for each of the 3 exposures");
  EXPECT_THAT(
      refusal([](MeasuredTable& t, Camera&) { t.correlation = Eigen::MatrixXd::Random(40, 2); }),
      HasSubstr("measurements = 1; must be in [3, 64]"));
  EXPECT_THAT(refusal([](MeasuredTable& t, Camera& c) {
                c = camera_with("paper-10f0");
                t.taps = 1;
                t.correlation = Eigen::MatrixXd::Random(40, 2);
              }),
              HasSubstr("must be >= 3: there are three unknowns, signal, ambient light and depth"));
  EXPECT_THAT(refusal([](MeasuredTable& t, Camera&) {
                t.correlation = Eigen::VectorXd::Random(40) * Eigen::RowVectorXd::Random(6);
              }),
              HasSubstr("rank"));
}

TEST(MeasuredAmbient, HasThreeValidNames) {
  for (const auto ambient : {MeasuredAmbient::equal, MeasuredAmbient::mean, MeasuredAmbient::none})
    EXPECT_EQ(parse_measured_ambient(name_of(ambient)), ambient);
  EXPECT_THROW(parse_measured_ambient("some"), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
