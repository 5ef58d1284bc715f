// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "decode/ambient_projection.hpp"
#include "decode/output/pixel_model.hpp"
#include "decode_setup.hpp"
#include "tofsmith/decode/decode_method.hpp"

namespace tofsmith {

namespace {

/// Its chords equal the true correlation functions.
DecodingTable fine_table_of(const std::string& code, Camera camera) {
  camera.samples *= 16;
  return decoding_table_of(code, camera);
}

double share_of(const DepthImage& image, PixelStatus status) {
  const auto count = std::count(image.status.pixels.begin(), image.status.pixels.end(), status);
  return static_cast<double>(count) / static_cast<double>(image.status.size());
}

double mean_residual(const DepthImage& image) {
  double sum = 0.0;
  for (const float residual : image.residual.pixels) sum += residual;
  return sum / static_cast<double>(image.residual.size());
}

/// Measurements from `first` on see another depth.
std::vector<float> displaced_pixels(const DecodingTable& table, double signal, double near_bin,
                                    double far_bin, int first, int pixels) {
  std::vector<float> raw, other;
  RandomStream random(4, 0);
  for (int i = 0; i < pixels; ++i) {
    append_noisy_pixel(table, signal, 1e3, near_bin, random, raw);
    other.clear();
    append_noisy_pixel(table, signal, 1e3, far_bin, random, other);
    std::copy(other.begin() + first, other.end(), raw.end() - (table.measurements() - first));
  }
  return raw;
}

struct ResidualCase {
  DecodeMethod method;
  const char* code;
  const char* camera;
  int taps = 1;
  Readout readout = Readout::separate;
};

void PrintTo(const ResidualCase& c, std::ostream* out) {
  *out << name_of(c.method) << ", " << c.code << " on " << c.camera << ", " << c.taps << " taps";
}

class ResidualOfCode : public testing::TestWithParam<ResidualCase> {
 protected:
  const Camera camera = camera_with(GetParam().camera, GetParam().taps, GetParam().readout);
  const DecodingTable table = decoding_table_of(GetParam().code, camera);
  const DecodingTable actual = fine_table_of(GetParam().code, camera);
  /// Ambient light cancels in differences; decoders assume the camera's level.
  const double ambient_e_per_s =
      camera.sensor.readout == Readout::separate ? 1e3 : camera.operating.middle().ambient_e_per_s;
};

TEST_P(ResidualOfCode, MarksConsistentPixelsAtTheConfiguredRate) {
  const int pixels = GetParam().method == DecodeMethod::ml ? 4000 : 20000;
  const double rate = 0.02;
  for (const double signal : {3e4, 1e5, 1e7}) {
    const DepthImage image = decode_row(GetParam().method, table,
                                        noisy_pixels(actual, signal, ambient_e_per_s, pixels, 1),
                                        {.min_confidence = 0.0, .false_alarm_rate = rate});
    const double error = std::sqrt(rate / pixels);
    EXPECT_NEAR(share_of(image, PixelStatus::inconsistent), rate, 4 * error + 0.05 * rate)
        << signal;
    EXPECT_NEAR(mean_residual(image), 1.0, 4 * std::sqrt(2.0 / pixels) + 0.02) << signal;
  }
}

TEST_P(ResidualOfCode, DetectsMeasurementsOfTwoDepths) {
  const double samples = actual.samples();
  const DepthImage image = decode_row(
      GetParam().method, table,
      displaced_pixels(actual, 1e6, 0.2 * samples, 0.27 * samples, table.measurements() / 2, 500));
  EXPECT_GE(share_of(image, PixelStatus::inconsistent), 0.99);
}

TEST_P(ResidualOfCode, AccountsForAveragedMeasurements) {
  constexpr int pixels = 1000, averaged = 64;
  const std::vector<float> raw = noisy_pixels(actual, 1e5, 1e3, pixels, 2);
  const std::vector<float> as_means(pixels, averaged);
  const DepthImage single = decode_row(GetParam().method, table, raw);
  const DepthImage mean = decode_row(GetParam().method, table, raw, {}, as_means.data());
  for (std::size_t i = 0; i < pixels; ++i)
    ASSERT_NEAR(mean.residual.pixels[i], averaged * single.residual.pixels[i],
                0.01 * averaged * (single.residual.pixels[i] + 0.1f));
}

INSTANTIATE_TEST_SUITE_P(
    Codes, ResidualOfCode,
    testing::Values(
        ResidualCase{DecodeMethod::zncc, "hamiltonian-k4", "paper-10f0"},
        ResidualCase{DecodeMethod::zncc, "hamiltonian-k5", "paper-10f0"},
        ResidualCase{DecodeMethod::zncc, "sinusoid-k4", "paper-10f0"},
        ResidualCase{DecodeMethod::zncc, "sinusoid-k8", "paper-10f0"},
        ResidualCase{DecodeMethod::zncc, "hamiltonian-k4", "paper-10f0", 2},
        ResidualCase{DecodeMethod::zncc, "hamiltonian-k5", "paper-10f0", 2, Readout::difference},
        ResidualCase{DecodeMethod::ml, "hamiltonian-k5", "paper-10f0"},
        ResidualCase{DecodeMethod::ml, "sinusoid-k4", "paper-10f0", 2, Readout::difference},
        ResidualCase{DecodeMethod::unwrap, "sinusoid-k4", "paper-10f0"},
        ResidualCase{DecodeMethod::unwrap, "multifrequency-1x4-3x4", "paper-10f0"}));

TEST(Residual, IsMissingWithoutDegreesOfFreedom) {
  const DecodingTable table = decoding_table_of("hamiltonian-k3", camera_with("paper-10f0"));
  for (const DecodeMethod method : {DecodeMethod::zncc, DecodeMethod::ml}) {
    const DepthImage image = decode_row(method, table, noisy_pixels(table, 1e5, 1e3, 200, 3));
    for (const float residual : image.residual.pixels) EXPECT_TRUE(std::isnan(residual));
    EXPECT_EQ(share_of(image, PixelStatus::inconsistent), 0.0);
  }
}

TEST(Residual, MarksNothingAtRateZero) {
  const DecodingTable table = decoding_table_of("sinusoid-k8", camera_with("paper-10f0"));
  std::vector<float> raw = noisy_pixels(table, 1e6, 1e3, 200, 3);
  for (std::size_t i = 0; i < raw.size(); i += 8) raw[i] += 2000.0f;
  for (const DecodeMethod method : {DecodeMethod::zncc, DecodeMethod::ml, DecodeMethod::unwrap}) {
    EXPECT_EQ(share_of(decode_row(method, table, raw), PixelStatus::inconsistent), 1.0);
    const DepthImage unchecked = decode_row(method, table, raw, {.false_alarm_rate = 0.0});
    EXPECT_EQ(share_of(unchecked, PixelStatus::inconsistent), 0.0);
    EXPECT_GT(mean_residual(unchecked), 10.0);
  }
}

TEST(Residual, ToleratesTheConfiguredModelError) {
  // Every measurement is off by 2 % of its variation over depth.
  const DecodingTable table = decoding_table_of("sinusoid-k8", camera_with("paper-10f0"));
  DecodingTable actual = fine_table_of("sinusoid-k8", camera_with("paper-10f0"));
  const Eigen::RowVectorXd mean = actual.correlation.colwise().mean();
  for (int k = 0; k < 8; ++k)
    actual.correlation.col(k) +=
        (k % 2 == 0 ? 0.02 : -0.02) * (actual.correlation.col(k).array() - mean[k]).matrix();
  const std::vector<float> raw = noisy_pixels(actual, 1e7, 1e3, 1000, 3);
  for (const DecodeMethod method : {DecodeMethod::zncc, DecodeMethod::ml, DecodeMethod::unwrap}) {
    EXPECT_GT(share_of(decode_row(method, table, raw), PixelStatus::inconsistent), 0.5);
    EXPECT_LE(share_of(decode_row(method, table, raw, {.model_error_percent = 2.0}),
                       PixelStatus::inconsistent),
              0.005);
  }
}

TEST(Residual, IsSmallIfTwoReturnsExplainThePixel) {
  const DecodingTable table =
      decoding_table_of("multifrequency-1x4-2x4-3x4", camera_with("paper-10f0"));
  const DecodingTable actual =
      fine_table_of("multifrequency-1x4-2x4-3x4", camera_with("paper-10f0"));
  std::vector<float> raw;
  RandomStream random(4, 0);
  for (int i = 0; i < 300; ++i) {
    std::vector<float> second;
    append_noisy_pixel(actual, 1e6, 1e3, 0.2 * actual.samples(), random, raw);
    append_noisy_pixel(actual, 4e5, 0.0, 0.4 * actual.samples(), random, second);
    for (std::size_t k = 0; k < second.size(); ++k)
      raw[raw.size() - second.size() + k] += second[k];
  }
  EXPECT_GT(share_of(decode_row(DecodeMethod::zncc, table, raw), PixelStatus::inconsistent), 0.99);
  const DepthImage two = decode_row(DecodeMethod::two_return, table, raw);
  EXPECT_LT(share_of(two, PixelStatus::inconsistent), 0.05);
  EXPECT_NEAR(mean_residual(two), 1.0, 0.3);
}

constexpr int pixels = 40000;
constexpr double depth_bin = 61.3;

DepthImage captured(const DecodeSetup& setup, double signal) {
  const DecodingTable& table = setup.decoder.table();
  return setup.decoder.decode(
      frame_by_pixel(table.measurements(), 1, pixels, 1,
                     [&](int, int, RandomStream& random, std::vector<float>& values) {
                       append_noisy_pixel(table, signal, 1e4, depth_bin, random, values);
                     }));
}

double length_of_directions(const DecodingTable& table) {
  Eigen::MatrixXd curve = AmbientProjection(table).curve;
  curve.rowwise().normalize();
  double length = 0.0;
  for (Eigen::Index n = 0; n < curve.rows(); ++n)
    length += std::acos(std::clamp(curve.row(n).dot(curve.row((n + 1) % curve.rows())), -1.0, 1.0));
  return length;
}

/// `deviations` is the signal in units of its standard deviation.
double signal_of(const DecodingTable& table, double deviations) {
  const AmbientProjection projection(table);
  const PixelModel model(table, projection);
  const Position position = Position::at(depth_bin);
  double signal = 1e4;
  for (int i = 0; i < 30; ++i) {
    const Eigen::VectorXd light =
        signal * projection.gated.row(position.bin).transpose() + 1e4 * projection.ambient;
    std::array<double, max_measurements> plane, variance;
    model.project(light.data(), plane.data());
    signal = deviations *
             model.estimate(light.data(), plane.data(), {position.bin, 0.0}, variance.data())
                 .signal_standard_deviation_e_per_s;
  }
  return signal;
}

// The estimated signal is the maximum of a random field along the curve of directions. Its tail
// probability is proportional to the length of the curve (Rice).
TEST(WeakLight, FalseDetectionRateFollowsTheLengthOfTheCurve) {
  for (const char* code : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k5"}) {
    DecodeOptions options;
    options.min_confidence = 0.0;
    const DecodeSetup setup(code, camera_with("paper-10f0"), options);
    const DepthImage image = captured(setup, 0.0);
    const auto ok = static_cast<double>(
        std::count(image.status.pixels.begin(), image.status.pixels.end(), PixelStatus::ok));
    const double t = options.low_signal_sigma;
    const double expected = length_of_directions(setup.decoder.table()) / (2 * std::numbers::pi) *
                            std::exp(-0.5 * t * t);
    EXPECT_NEAR(ok / pixels / expected, 1.0, 0.2) << code << ' ' << expected;
  }
}

TEST(WeakLight, NoDepthIsTrustedWithoutLight) {
  for (const char* code : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k5"}) {
    const DecodeSetup setup(code, camera_with("paper-10f0"));
    const DepthImage image = captured(setup, 0.0);
    double sum = 0.0;
    int count = 0, ok = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
      const float confidence = image.confidence.pixels[i];
      if (std::isnan(confidence)) continue;
      sum += confidence;
      ++count;
      ok += image.status.pixels[i] == PixelStatus::ok;
    }
    // The main lobe is a tenth of the range.
    EXPECT_LT(sum / count, 0.35) << code;
    EXPECT_LT(ok, 2e-3 * pixels) << code;
  }
}

TEST(WeakLight, DeviationIsTheSpreadOfDepthFromFiveSignalDeviationsOn) {
  DecodeOptions options;
  options.min_confidence = 0.0;  // otherwise noise may move a depth out of the main lobe
  for (const char* code : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k5"}) {
    const DecodeSetup setup(code, camera_with("paper-10f0"), options);
    const DecodingTable& table = setup.decoder.table();
    const DepthImage image = captured(setup, signal_of(table, 5.0));
    double squares = 0.0, count = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) {
      if (image.status.pixels[i] != PixelStatus::ok) continue;
      const double error =
          std::remainder(image.depth_m.pixels[i] / table.bin_m() - depth_bin, table.bin_count()) *
          table.bin_m();
      const double deviation = image.deviation_m.pixels[i];
      if (std::abs(error) > 4 * deviation) continue;  // in another lobe
      squares += std::pow(error / deviation, 2), ++count;
    }
    EXPECT_GT(count, 0.9 * pixels) << code;
    EXPECT_NEAR(std::sqrt(squares / count), 1.0, 0.15) << code;
  }
}

}  // namespace

}  // namespace tofsmith
