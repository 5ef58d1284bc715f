// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/decoder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/shared/random.hpp"
#include "decode/search/shared/pixel_tile.hpp"
#include "decode/table_resolution.hpp"
#include "each_target.hpp"
#include "output_setup.hpp"
#include "random_codes.hpp"
#include "reference_decoder.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

struct Case {
  const char* code;
  int taps = 1;
  Readout readout = Readout::separate;
};
constexpr Case cases[] = {{"sinusoid-k4"},
                          {"square-k4"},
                          {"hamiltonian-k3"},
                          {"hamiltonian-k4"},
                          {"hamiltonian-k5"},
                          {"multifrequency-k5"},
                          {"pulsed-multifrequency-k5"},
                          {"gray-k4"},
                          {"hamiltonian-k4", 2},
                          {"hamiltonian-k5", 2, Readout::difference},
                          {"gray-k4", 2}};

std::string name_of_case(const Case& c) {
  return std::string(c.code) + (c.taps == 2 ? " x 2" : "") +
         (c.readout == Readout::difference ? " difference" : "");
}

/// Returns where the code has clear contrast and a direction that no other depth shares.
std::vector<bool> is_distinguishable(const DecodingTable& table) {
  const Eigen::VectorXd a = table.exposure_s.cwiseProduct(table.ambient_gain);
  Eigen::MatrixXd x = table.correlation * table.exposure_s.asDiagonal();
  if (a.norm() > 1e-9) x -= x * a * a.transpose() / a.squaredNorm();
  const Eigen::VectorXd contrast = x.rowwise().norm() / x.rowwise().norm().maxCoeff();
  std::vector<bool> unique;
  for (const double value : contrast) unique.push_back(value > 0.1);
  for (const AmbiguousDepths& pair : ambiguous_depths(table))
    unique[static_cast<std::size_t>(pair.first_bin)] =
        unique[static_cast<std::size_t>(pair.second_bin)] = false;
  return unique;
}

double largest_error_bin(const DecodeSetup& setup) {
  const std::vector<bool> unique = is_distinguishable(setup.decoder.table());
  const int samples = setup.decoder.samples();
  std::vector<double> truth;
  std::vector<float> raw;
  for (int i = 0; i < 4 * samples; ++i) {
    const double z = 0.25 * i;
    const auto from = static_cast<std::size_t>(z), to = (from + 1) % unique.size();
    if (!unique[from] || !unique[to]) continue;
    truth.push_back(z);
    setup.append_expected(raw, 1e6, z, 1e4);
  }
  EXPECT_GT(truth.size(), 2u * static_cast<std::size_t>(samples));
  const std::vector<double> found = depth_bins_of(setup.decoder, raw);
  double largest = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    largest = std::max(largest, std::abs(circular_difference(found[i], truth[i], samples)));
  return largest;
}

TEST(Decoder, RecoversEveryDepthWithoutNoise) {
  for (const Case& c : cases) {
    // Without a band limit the curves are polygons through the bins, and depths are exact.
    EXPECT_LT(largest_error_bin(DecodeSetup(c.code, camera_with("paper-30x", c.taps, c.readout))),
              1e-3)
        << name_of_case(c);
    // Smoothed one-tap Gray codes pass through a word without contrast and return on the same ray.
    if (c.taps == 1 && std::string_view(c.code) == "gray-k4") continue;
    for (const char* camera : {"paper-10f0", "paper-5f0"})
      EXPECT_LT(largest_error_bin(DecodeSetup(c.code, camera_with(camera, c.taps, c.readout))),
                0.02)
          << name_of_case(c) << " on " << camera;
  }
}

TEST(Decoder, RecoversEveryDepthOnTheRiseOfARamp) {
  // Ramps have unequal duties. Depths are ambiguous near the ends, where the ramps fall.
  for (const char* code : {"single-ramp-k3", "double-ramp-k3"}) {
    const DecodeSetup setup(code, camera_with("paper-30x"));
    for (double z = 10.0; z < 225.0; z += 0.25) {
      std::vector<float> raw;
      setup.append_expected(raw, 1e6, z, 1e4);
      EXPECT_NEAR(depth_bins_of(setup.decoder, raw)[0], z, 1e-3) << code;
    }
  }
}

/// Sums and multiples of whole electrons are exact in single precision.
std::vector<float> whole_noisy_pixels(const DecodingTable& table, int pixels) {
  std::vector<float> raw = noisy_pixels(table, 1e4, 1e4, pixels, 7);
  for (float& value : raw) value = std::round(value);
  return raw;
}

TEST(Decoder, AddingAmbientLightLeavesDepthUnchanged) {
  for (const char* code : {"hamiltonian-k4", "hamiltonian-k3"}) {
    const DecodeSetup setup(code, camera_with("paper-10f0"));
    const std::vector<float> raw = whole_noisy_pixels(setup.decoder.table(), 5000);
    std::vector<float> brighter = raw;
    for (float& value : brighter) value += 30000.0f;
    EXPECT_EQ(bins_of(setup.decoder, raw), bins_of(setup.decoder, brighter));
    const auto a = depth_bins_of(setup.decoder, raw), b = depth_bins_of(setup.decoder, brighter);
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_NEAR(circular_difference(a[i], b[i], 240), 0.0, 1e-6);
  }
}

TEST(Decoder, ScalingTheLightLeavesDepthUnchanged) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  const std::vector<float> raw = whole_noisy_pixels(setup.decoder.table(), 5000);
  for (const float factor : {3.0f, 1e-30f, 1e28f}) {
    std::vector<float> scaled = raw;
    for (float& value : scaled) value *= factor;
    const auto a = depth_bins_of(setup.decoder, raw), b = depth_bins_of(setup.decoder, scaled);
    // Non-integer factors cause rounding.
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_NEAR(circular_difference(a[i], b[i], 240), 0.0, factor == 3.0f ? 1e-6 : 0.05);
  }
}

TEST(Decoder, ReadsCountsAsElectrons) {
  Camera camera = camera_with("paper-10f0");
  const DecodeSetup electrons("hamiltonian-k4", camera);
  camera.sensor.adc_bits = 16;
  camera.sensor.gain_e_per_dn = 0.5;
  camera.sensor.black_level_dn = 64.0;
  const DecodeSetup counts("hamiltonian-k4", camera);
  const std::vector<float> raw = whole_noisy_pixels(electrons.decoder.table(), 2000);
  std::vector<float> raw_counts = raw;
  for (float& value : raw_counts) value = 2.0f * value + 64.0f;
  EXPECT_EQ(bins_of(electrons.decoder, raw), bins_of(counts.decoder, raw_counts));
}

TEST(Decoder, GivesTheSameBitsOnAnyNumberOfThreads) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  constexpr int pixels = 20011;
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 3e3, 1e4, pixels, 5);
  const auto decode_on = [&](int threads) {
    const ThreadLimit limit(threads);
    Outputs outputs(pixels);
    setup.decoder.decode(RawView::interleaved(raw.data(), 1, pixels, 4), outputs.view());
    return outputs;
  };
  expect_same(decode_on(1), decode_on(4));
}

TEST(Decoder, DecodesEachFrameIndependently) {
  const DecodeSetup setup("hamiltonian-k3", camera_with("paper-30x"));
  RawFrames frames = frame_of({}, 3);
  frames.frames = 2;
  frames.width = 1;
  setup.append_expected(frames.values, 1e5, 60.0, 0.0);
  setup.append_expected(frames.values, 1e5, 120.0, 0.0);
  EXPECT_NEAR(setup.decoder.decode(frames, 0).depth_m(0, 0), setup.camera.range_m() / 4, 1e-5);
  EXPECT_NEAR(setup.decoder.decode(frames, 1).depth_m(0, 0), setup.camera.range_m() / 2, 1e-5);
  EXPECT_THROW(setup.decoder.decode(frames, 2), std::invalid_argument);
  frames.measurements = 4;
  EXPECT_THROW(setup.decoder.decode(frames, 0), std::invalid_argument);
}

TEST(Decoder, StopsOnRequest) {
  const DecodeSetup setup("hamiltonian-k3", camera_with("paper-30x"));
  const RawFrames frame = frame_of(std::vector<float>(300, 1.0f), 3);
  EXPECT_THROW(setup.decoder.decode(frame, 0, [](double, std::string_view) { return false; }),
               Interrupted);
}

TEST(DecodeOptions, NamesTheFieldTheValueAndTheRule) {
  DecodeOptions options;
  options.min_confidence = 1.5;
  try {
    options.validate();
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "DecodeOptions::min_confidence = 1.5; must be in [0, 1]");
  }
  options = {.low_signal_sigma = -1.0};
  EXPECT_THROW(options.validate(), std::invalid_argument);
}

TEST(Decoder, RecoversDepthFromTwoMeasurementsIfAmbientLightCancels) {
  constexpr int samples = 120, pixels = 2 * pixels_per_tile + 7;
  Eigen::MatrixXd circle(samples, 2);
  for (int n = 0; n < samples; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / samples;
    circle.row(n) << std::cos(angle), std::sin(angle);
  }
  DecodingTable table = make_decoding_table(circle, 10.0);
  table.ambient_gain.setZero();
  const Decoder decoder(table);
  std::vector<float> raw;
  for (int i = 0; i < pixels; ++i)
    for (int k = 0; k < 2; ++k) raw.push_back(static_cast<float>(1000.0 * circle(i % samples, k)));
  for_each_target([&] {
    Outputs all(pixels);
    decoder.decode(RawView::interleaved(raw.data(), 1, pixels, 2), all.view());
    Outputs bins(pixels);
    decoder.decode(RawView::interleaved(raw.data(), 1, pixels, 2), bins.view(1));
    for (std::size_t i = 0; i < pixels; ++i) {
      EXPECT_EQ(all.bin.pixels[i], static_cast<int>(i) % samples);
      EXPECT_EQ(bins.bin.pixels[i], static_cast<int>(i) % samples);
    }
  });
}

TEST(DecoderOfRandomCodes, FindsTheBinsOfTheDefinition) {
  RandomStream random(23, 0);
  for (const RandomCode& code : random_codes) {
    const DecodingTable table = random_table(code, random);
    const Decoder decoder(table);
    const ReferenceDecoder reference(table);
    const int pixels = std::min(600, 400'000 / code.samples);
    const std::vector<float> raw = random_pixels(table, pixels, random);
    std::vector<std::int32_t> expected;
    for (int i = 0; i < pixels; ++i)
      expected.push_back(reference.bin(raw.data() + i * code.measurements));
    for_each_target([&](std::int64_t) {
      std::vector<std::int32_t> bin(expected.size());
      decoder.decode_bins(raw.data(), pixels, bin.data());
      for (int i = 0; i < pixels; ++i) {
        std::int32_t alone = 0;
        decoder.decode_bins(raw.data() + i * code.measurements, 1, &alone);
        ASSERT_EQ(bin[static_cast<std::size_t>(i)], expected[static_cast<std::size_t>(i)])
            << "pixel " << i << " of K = " << code.measurements << ", N = " << code.samples;
        ASSERT_EQ(alone, expected[static_cast<std::size_t>(i)]) << "pixel " << i;
      }
    });
  }
}

/// Triangle waves and integer raw values, which every processor computes identically.
struct WholeNumbers {
  WholeNumbers(int measurements, int samples, int pixels, RandomStream& random) {
    table.correlation.resize(samples, measurements);
    for (int k = 0; k < measurements; ++k) {
      const double shift = random.uniform(), second = random.uniform();
      for (int n = 0; n < samples; ++n) {
        const double at = n / double(samples) + shift, twice = 2 * at + second;
        table.correlation(n, k) = std::abs(2 * (at - std::floor(at)) - 1) +
                                  0.5 * std::abs(2 * (twice - std::floor(twice)) - 1);
      }
    }
    table = table_of_rows(table.correlation, 1.0);
    for (int i = 0; i < pixels; ++i) {
      const int n =
          i < pixels / 2 ? i * samples / pixels : static_cast<int>(random.uniform() * samples);
      const double signal = 50 + 5000 * random.uniform();
      for (int k = 0; k < measurements; ++k)
        raw.push_back(static_cast<float>(
            std::floor(1000 + signal * table.correlation(n, k) + 40 * random.uniform())));
    }
  }
  DecodingTable table;
  std::vector<float> raw;
};

TEST(DecoderOfRandomCodes, FindsTheSameBinsOnEveryProcessor) {
  RandomStream random(31, 0);
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  for (const int measurements : {3, 4, 5, 8, 11})
    for (const int samples : {20, 240, 1000}) {
      constexpr int pixels = 1000;
      const WholeNumbers input(measurements, samples, pixels, random);
      const Decoder decoder(input.table);
      std::vector<std::int32_t> bin(pixels);
      decoder.decode_bins(input.raw.data(), pixels, bin.data());
      for (const std::int32_t n : bin)
        hash = (hash ^ static_cast<std::uint32_t>(n)) * 1099511628211u;
    }
  // Result of an x86 processor with AVX-512.
  EXPECT_EQ(hash, 11286135160687803514u);
}

/// Few directions of many bins each; small integers often tie two of them.
DecodingTable table_of_steps(RandomStream& random) {
  constexpr int samples = 3000, steps = 35, measurements = 4;
  Eigen::MatrixXd levels(steps, measurements);
  for (double& level : levels.reshaped()) level = std::floor(4.0 * random.uniform());
  Eigen::MatrixXd correlation(samples, measurements);
  for (int n = 0; n < samples; ++n) correlation.row(n) = levels.row(n * steps / samples);
  return table_of_rows(correlation, 1.0);
}

TEST(DecoderOfRandomCodes, ResolvesTiesToTheLowestBinInBrightAmbientLight) {
  RandomStream random(37, 0);
  for (int code = 0; code < 20; ++code) {
    const Decoder decoder(table_of_steps(random));
    constexpr int pixels = 500, measurements = 4;
    std::vector<float> raw(pixels * measurements), brighter(raw.size());
    for (float& number : raw) number = static_cast<float>(std::floor(8.0 * random.uniform()));
    std::vector<std::int32_t> expected(pixels), bin(pixels);
    decoder.decode_bins(raw.data(), pixels, expected.data());
    for (const float ambient : {1000.0f, 8004.0f, 16000.0f}) {
      std::ranges::transform(raw, brighter.begin(), [&](float number) { return number + ambient; });
      decoder.decode_bins(brighter.data(), pixels, bin.data());
      for (int i = 0; i < pixels; ++i)
        ASSERT_EQ(bin[i], expected[i]) << "pixel " << i << " of code " << code << ", " << ambient;
    }
  }
}

}  // namespace

}  // namespace tofsmith
