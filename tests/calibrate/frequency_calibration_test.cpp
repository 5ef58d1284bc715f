// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/shared/random.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double turn_rad = 2 * std::numbers::pi;
constexpr const char* code_name = "multifrequency-4x4-5x4";

Camera two_frequencies() {
  Camera camera = built_in_camera("paper-10f0");
  camera.fundamental_frequency_hz = 20e6;
  camera.exposure_s.total_s = 2e-3;
  camera.light.impulse_response = camera.sensor.impulse_response = {};
  camera.sensor.taps = 2;
  camera.sensor.readout = Readout::difference;
  camera.sensor.drain = false;
  return camera;
}

/// Frames of a sensor whose frequencies, 4 f0 and 5 f0, have different offsets, contrasts and third
/// harmonics.
struct SensorUnderTest {
  std::array<double, 2> offset_rad{}, contrast{1.0, 1.0}, third{}, third_rad{};
  double nearest_m = 0.3, farthest_m = 7.0;
  double wrong_share = 0.0;  // of the reference pixels
  bool reversed = false;
  int frames = 6, height = 24, width = 32;

  double range_m = two_frequencies().range_m();
  RawFrames raw = {};
  ReferenceDepth reference = {};

  void run(std::uint64_t seed) {
    RandomStream random(seed, 1, 0);
    raw = {.frames = frames, .height = height, .width = width, .measurements = 8};
    reference.depth_m.clear();
    for (int f = 0; f < frames; ++f) {
      Image<float> depth_m(height, width);
      for (float& pixel_m : depth_m.pixels) {
        const double true_m = nearest_m + (farthest_m - nearest_m) * random.uniform();
        const double amplitude = 1e5 * (1.0 + random.uniform());
        for (int j = 0; j < 8; ++j) {
          const auto g = static_cast<std::size_t>(j / 4);
          const double travel_rad = turn_rad * (g == 0 ? 4 : 5) * true_m / range_m;
          const double step_rad = (j % 4) * turn_rad / 4;
          const double phase_rad = (reversed ? -travel_rad : travel_rad) + offset_rad[g] - step_rad;
          raw.values.push_back(static_cast<float>(
              amplitude * contrast[g] *
                  (std::cos(phase_rad) + third[g] * std::cos(3 * phase_rad + third_rad[g])) +
              std::sqrt(amplitude) * random.normal()));
        }
        pixel_m = static_cast<float>(random.uniform() < wrong_share ? range_m * random.uniform()
                                                                    : true_m);
      }
      reference.depth_m.push_back(std::move(depth_m));
    }
  }

  CalibratedDepth calibrate() const {
    const Camera camera = two_frequencies();
    return calibrate_depth(raw, reference, build_family(code_name, camera), camera);
  }

  /// Root mean square error [m], excluding the largest 2 %.
  double error_m(const DecodingTable& table,
                 const std::optional<DepthCorrection>& correction) const {
    const Decoder decoder(table);
    std::vector<double> squares;
    for (int f = 0; f < frames; ++f) {
      DepthImage image = decoder.decode(raw, f);
      if (correction)
        apply(*correction, range_m, DecodedView::of(image), height, width, 0, image.depth_m.size());
      for (std::size_t i = 0; i < image.depth_m.size(); ++i) {
        const double off_m = static_cast<double>(
            image.depth_m.pixels[i] - reference.depth_m[static_cast<std::size_t>(f)].pixels[i]);
        squares.push_back(std::pow(off_m - range_m * std::round(off_m / range_m), 2));
      }
    }
    std::ranges::sort(squares);
    squares.resize(squares.size() * 98 / 100);
    double sum = 0.0;
    for (const double square : squares) sum += square;
    return std::sqrt(sum / static_cast<double>(squares.size()));
  }
};

double wrapped(double value, double period) { return value - period * std::round(value / period); }

TEST(FrequencyCalibration, FindsOffsetContrastAndHarmonicsOfEachFrequency) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    RandomStream random(seed, 2, 0);
    SensorUnderTest sensor{.wrong_share = 0.05, .reversed = seed % 2 == 0};
    for (std::size_t g = 0; g < 2; ++g) {
      sensor.offset_rad[g] = turn_rad * (random.uniform() - 0.5);
      sensor.contrast[g] = 0.4 + 0.6 * random.uniform();
      sensor.third[g] = 0.1 * random.uniform();
      sensor.third_rad[g] = turn_rad * random.uniform();
    }
    sensor.run(seed);
    const CalibratedDepth found = sensor.calibrate();
    ASSERT_EQ(found.frequencies.size(), 2u);
    EXPECT_EQ(found.reversed, sensor.reversed);
    const double mean_contrast = std::sqrt(sensor.contrast[0] * sensor.contrast[1]);
    for (std::size_t g = 0; g < 2; ++g) {
      const CalibratedFrequency& its = found.frequencies[g];
      EXPECT_DOUBLE_EQ(its.frequency_hz, g == 0 ? 80e6 : 100e6);
      const double period_m = sensor.range_m / (g == 0 ? 4 : 5);
      const double sign = sensor.reversed ? -1.0 : 1.0;
      EXPECT_NEAR(
          wrapped(its.offset_m.value - sign * sensor.offset_rad[g] / turn_rad * period_m, period_m),
          0.0, 5 * its.offset_m.standard_error);
      EXPECT_LT(its.offset_m.standard_error, 2e-4);
      EXPECT_NEAR(its.contrast.value, sensor.contrast[g] / mean_contrast,
                  5 * its.contrast.standard_error);
      ASSERT_THAT(its.harmonics, Contains(testing::Field(&CalibratedHarmonic::harmonic, 3)));
      for (const CalibratedHarmonic& h : its.harmonics) {
        const double true_share = h.harmonic == 3 ? sensor.third[g] : 0.0;
        EXPECT_NEAR(std::hypot(h.in_phase.value, h.quadrature.value), true_share,
                    5 * h.in_phase.standard_error + 1e-4)
            << h.harmonic;
      }
    }
  }
}

TEST(FrequencyCalibration, LeavesOnlyNoise) {
  SensorUnderTest exact;
  exact.run(7);
  const Camera camera = two_frequencies();
  const DecodingTable model =
      make_decoding_table(ForwardModel(build_family(code_name, camera), camera), camera);
  const double noise_m = exact.error_m(model, {});

  SensorUnderTest sensor{.offset_rad = {0.7, -2.0}, .contrast = {0.9, 0.5}, .third = {0.11, 0.05}};
  sensor.run(7);
  EXPECT_GT(sensor.error_m(model, {}), 100 * noise_m);
  const CalibratedDepth found = sensor.calibrate();
  EXPECT_LT(sensor.error_m(make_decoding_table(found.table, camera), found.table.correction),
            2.0 * noise_m);
  // The camera without the table has offsets and contrasts, but no harmonics.
  const Camera calibrated = with_depth(camera, found);
  const DecodingTable table = make_decoding_table(
      ForwardModel(build_family(code_name, calibrated), calibrated), calibrated);
  EXPECT_LT(sensor.error_m(table, {}), 20e-3);
  EXPECT_EQ(calibrated.playback->offsets_m.size(), 2u);
}

TEST(FrequencyCalibration, ReportsTermsThatASingleDistanceDoesNotDetermine) {
  SensorUnderTest sensor{.offset_rad = {0.7, -0.4}, .nearest_m = 2.0, .farthest_m = 2.0 + 1e-9};
  sensor.run(3);
  const CalibratedDepth found = sensor.calibrate();
  ASSERT_EQ(found.frequencies.size(), 2u);
  for (const CalibratedFrequency& its : found.frequencies) EXPECT_THAT(its.harmonics, IsEmpty());
  EXPECT_THAT(found.notes, Contains(HasSubstr("80 MHz: harmonics 2 to 8 are not determined")));
  EXPECT_LT(
      sensor.error_m(make_decoding_table(found.table, two_frequencies()), found.table.correction),
      2e-3);
}

TEST(FrequencyCalibration, DoesNotApplyToASingleFrequency) {
  Camera camera = two_frequencies();
  SensorUnderTest sensor;
  sensor.run(1);
  RawFrames first = sensor.raw;
  first.measurements = 4;
  first.values.clear();
  for (std::size_t i = 0; i < sensor.raw.values.size(); ++i)
    if (i % 8 < 4) first.values.push_back(sensor.raw.values[i]);
  camera.fundamental_frequency_hz = 80e6;
  const CalibratedDepth found =
      calibrate_depth(first, sensor.reference, build_family("sinusoid-k4", camera), camera);
  EXPECT_THAT(found.frequencies, IsEmpty());
}

}  // namespace
}  // namespace tofsmith
