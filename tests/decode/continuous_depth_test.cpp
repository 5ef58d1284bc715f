// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Noise-free and noisy measurements at any real depth, compared with the continuous correlation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "decode_setup.hpp"
#include "sanitizers.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

using Frequencies = std::vector<FrequencySteps>;

std::string name_of(const Frequencies& list) {
  std::string name = "multifrequency";
  for (const auto& [frequency, steps] : list)
    name += "-" + std::to_string(frequency) + "x" + std::to_string(steps);
  return name;
}

Camera two_bucket_camera(double fundamental_frequency_hz, int samples) {
  Camera camera;
  camera.operating = paper_operating_range();
  camera.fundamental_frequency_hz = fundamental_frequency_hz;
  camera.samples = samples;
  camera.light.impulse_response = camera.sensor.impulse_response = {};
  camera.sensor.taps = 2;
  camera.sensor.drain = false;
  camera.sensor.readout = Readout::difference;
  camera.sensor.read_noise_e = 5.0;
  return camera;
}

/// Appends differences of two buckets for sinusoids, by formula and without the forward model.
/// @param contrast  per frequency
void append_sinusoids(const Frequencies& list, const std::vector<double>& contrast, double signal_e,
                      double periods, std::vector<float>& raw) {
  for (std::size_t f = 0; f < list.size(); ++f)
    for (int step = 0; step < list[f].steps; ++step) {
      const double phase = step / static_cast<double>(list[f].steps == 2 ? 4 : list[f].steps);
      raw.push_back(static_cast<float>(
          signal_e * contrast[f] *
          std::cos(2.0 * std::numbers::pi * (list[f].frequency * periods - phase))));
    }
}

double largest_error_m(DecodeMethod method, const Frequencies& list, const Camera& camera,
                       const std::vector<double>& contrast, int pixels, std::uint64_t seed) {
  const DecodingTable table = decoding_table_of(name_of(list), camera);
  EXPECT_EQ(table.bin_count(), camera.samples);
  RandomStream random(seed, 0);
  std::vector<float> raw;
  std::vector<double> truth_m;
  for (int i = 0; i < pixels; ++i) {
    const double periods = random.uniform();
    truth_m.push_back(periods * table.range_m);
    append_sinusoids(list, contrast, 1e4 * (0.9 + 0.2 * random.uniform()), periods, raw);
  }
  const DepthImage image = decode_row(method, table, raw);
  double largest = 0.0;
  for (std::size_t i = 0; i < truth_m.size(); ++i) {
    const double found_m = image.depth_m.pixels[i];
    EXPECT_FALSE(std::isnan(found_m)) << i;
    largest = std::max(largest, std::abs(circular_difference(found_m, truth_m[i], table.range_m)));
  }
  return largest;
}

TEST(Decoder, DecodesCloseWrapsWithoutNoiseAtAnyNumberOfSamples) {
  for (const Frequencies& list :
       {Frequencies{{59, 4}, {60, 4}}, Frequencies{{83, 4}, {100, 4}},
        Frequencies{{63, 3}, {64, 2}}, Frequencies{{97, 4}, {100, 4}},
        Frequencies{{29, 4}, {30, 4}, {31, 4}}, Frequencies{{150, 3}, {180, 3}, {200, 3}, {1, 2}},
        Frequencies{{399, 3}, {400, 5}}, Frequencies{{1, 4}, {2, 4}}})
    for (const int samples : {8, 240})
      EXPECT_LT(largest_error_m(DecodeMethod::zncc, list, two_bucket_camera(1e6, samples),
                                std::vector<double>(list.size(), 1.0), 250, 1),
                2e-5)
          << name_of(list) << ", " << samples;
}

TEST(Decoder, DecodesNoiseFreePixelsOfRandomFrequenciesToTheirDepth) {
  RandomStream random(4, 0);
  for (int set = 0; set < repetitions(12); ++set) {
    Frequencies list;
    int common = 0;
    do {
      list.clear(), common = 0;
      for (int i = 0; i < 2 + set % 2; ++i) {
        list.push_back({1 + static_cast<int>(400 * random.uniform()),
                        2 + static_cast<int>(4 * random.uniform())});
        common = std::gcd(common, list.back().frequency);
      }
    } while (common != 1);
    std::vector<double> contrast;
    for (std::size_t f = 0; f < list.size(); ++f) contrast.push_back(0.3 + 0.7 * random.uniform());
    EXPECT_LT(
        largest_error_m(DecodeMethod::zncc, list, two_bucket_camera(1e6, 240), contrast, 100, 2),
        2e-5)
        << name_of(list);
  }
}

TEST(Decoders, FindDepthsWithoutNoiseForAnyContrastPerFrequency) {
  const Frequencies three = {{2, 3}, {10, 3}, {15, 3}}, pair = {{1, 4}, {5, 4}};
  const std::vector<double> contrast = {1.0, 1.0 / 1.3226, 1.0 / 1.6129};
  const Camera kinect = built_in_camera("kinect-v2");
  EXPECT_LT(largest_error_m(DecodeMethod::zncc, three, kinect, contrast, 500, 3), 5e-5);
  EXPECT_LT(largest_error_m(DecodeMethod::ml, three, kinect, contrast, 300, 3), 1e-4);
  EXPECT_LT(
      largest_error_m(DecodeMethod::zncc, pair, two_bucket_camera(20e6, 240), {1.0, 0.5}, 500, 3),
      5e-5);
}

TEST(Decoder, ChoosesTheWrapOfTheContinuousCorrelationInNoise) {
  const Frequencies list = {{19, 4}, {20, 4}};
  const Camera camera = two_bucket_camera(1e6, 240);
  const ForwardModel model(build_family(name_of(list), camera), camera);
  const Decoder decoder(make_decoding_table(model, camera));
  // Directions at steps of a thousandth of a bin. Ambient light cancels, and exposures are equal.
  const Eigen::MatrixXd directions = model.correlation_table(240'000).rowwise().normalized();
  RandomStream random(8, 0);
  constexpr int pixels = 60;
  int wrong = 0;
  for (int i = 0; i < pixels; ++i) {
    std::vector<float> raw;
    const double periods = random.uniform();
    append_sinusoids(list, {1.0, 1.0}, 1.0, periods, raw);
    for (float& value : raw) value += static_cast<float>(0.15 * random.normal());
    Eigen::Index best = 0;
    (directions * Eigen::Map<const Eigen::VectorXf>(raw.data(), std::ssize(raw)).cast<double>())
        .maxCoeff(&best);
    const double found = depth_bins_of(decoder, raw)[0];
    EXPECT_NEAR(circular_difference(found, 1e-3 * static_cast<double>(best), 240.0), 0.0, 1e-3);
    wrong += std::abs(circular_difference(found, 240.0 * periods, 240.0)) > 3.0;
  }
  EXPECT_GT(wrong, 0) << "too little noise to test anything";
}

TEST(Families, AcceptAnyNumberOfSamples) {
  for (const char* code : {"hamiltonian-k5", "gray-k4", "square-k3", "pulsed-multifrequency-k5-q5",
                           "multifrequency-97x4-100x4"})
    for (const int samples : {240, 241, 1000})
      EXPECT_NO_THROW(make_family(code, {.samples = samples})) << code << ", " << samples;
}

TEST(Decoder, DecodesSwitchedCodesWhoseEdgesFallBetweenBins) {
  Camera camera;
  camera.operating = paper_operating_range();
  camera.samples = 100;
  camera.light.impulse_response = camera.sensor.impulse_response = {};
  const DecodeSetup setup("hamiltonian-k5", camera);
  std::vector<float> raw;
  for (int i = 0; i < 500; ++i) setup.append_expected(raw, 1e6, 0.2 * i + 0.05, 1e4);
  const std::vector<double> found = depth_bins_of(setup.decoder, raw);
  for (int i = 0; i < 500; ++i)
    EXPECT_NEAR(circular_difference(found[static_cast<std::size_t>(i)], 0.2 * i + 0.05, 100.0), 0.0,
                1e-3);
}

}  // namespace
}  // namespace tofsmith
