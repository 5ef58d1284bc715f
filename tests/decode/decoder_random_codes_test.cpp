// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/shared/random.hpp"
#include "each_target.hpp"
#include "random_codes.hpp"
#include "reference_decoder.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {
namespace {

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
      for (std::size_t i = 0; i < bin.size(); ++i)
        ASSERT_EQ(bin[i], expected[i])
            << "pixel " << i << " of K = " << code.measurements << ", N = " << code.samples;
    });
  }
}

DecodingTable measured_table_of(Eigen::MatrixXd correlation) {
  DecodingTable table;
  const auto every = [&](double value) {
    return Eigen::VectorXd::Constant(correlation.cols(), value);
  };
  table.ambient_gain = table.exposure_s = table.gain_e_per_raw = every(1.0);
  table.dark_electrons = table.black_level = every(0.0);
  table.constant_variance_e2 = every(1.0);
  table.range_m = 1.0;
  table.correlation = std::move(correlation);
  return table;
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
    table = measured_table_of(std::move(table.correlation));
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
  return measured_table_of(correlation);
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

TEST(DecoderOfRandomCodes, FindsTheSameBinWhateverTheNeighbours) {
  RandomStream random(29, 0);
  for (const RandomCode& code : random_codes) {
    if (code.samples > 1000) continue;
    const DecodingTable table = random_table(code, random);
    const Decoder decoder(table);
    constexpr int pixels = 3000;
    const std::vector<float> raw = random_pixels(table, pixels, random);
    const auto k_count = static_cast<std::size_t>(code.measurements);
    std::vector<std::int32_t> alone(pixels), bin(pixels);
    for (int i = 0; i < pixels; ++i)
      decoder.decode_bins(&raw[static_cast<std::size_t>(i) * k_count], 1, &alone[i]);
    const auto expect_same = [&](const char* how) {
      for (std::size_t i = 0; i < bin.size(); ++i)
        ASSERT_EQ(bin[i], alone[i]) << how << ", pixel " << i << " of K = " << code.measurements;
    };
    for (const int first : {1, 7, 100}) {
      std::copy_n(alone.begin(), first, bin.begin());
      decoder.decode_bins(&raw[static_cast<std::size_t>(first) * k_count], pixels - first,
                          bin.data() + first);
      expect_same("from another pixel on");
    }
    for (const int threads : {1, 2, 3, 8}) {
      const ThreadLimit limit(threads);
      decoder.decode(RawView::interleaved(raw.data(), 30, 100, code.measurements),
                     {.bin = bin.data()});
      expect_same("on several threads");
    }
    std::vector<float> planar(raw.size());
    for (std::size_t i = 0; i < pixels; ++i)
      for (std::size_t k = 0; k < k_count; ++k) planar[k * pixels + i] = raw[i * k_count + k];
    decoder.decode(RawView::planar(planar.data(), 30, 100, code.measurements), {.bin = bin.data()});
    expect_same("from planes");
  }
}

}  // namespace
}  // namespace tofsmith
