// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "decode_setup.hpp"
#include "sanitizers.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

double between(RandomStream& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

/// Returns a smooth random code without repeated directions. Duty, exposure, gain, offset and dark
/// current differ between measurements.
DecodingTable random_table(RandomStream& random, int measurements) {
  const int samples = 24 + static_cast<int>(random() % 60);
  Eigen::MatrixXd correlation(samples, measurements);
  Eigen::VectorXd duty(measurements);
  for (int k = 0; k < measurements; ++k) {
    duty[k] = between(random, 0.1, 0.8);
    const double first = between(random, 0.5, 0.8), second = between(random, 0.0, 0.2);
    const double phase = (k + between(random, -0.2, 0.2)) / measurements;
    for (int n = 0; n < samples; ++n) {
      const double angle = 2 * M_PI * (static_cast<double>(n) / samples - phase);
      correlation(n, k) = duty[k] * (1 + first * std::cos(angle) +
                                     (measurements > 3 ? second * std::cos(2 * angle) : 0.0));
    }
  }
  DecodingTable table = make_decoding_table(correlation, 10.0);
  table.ambient_gain = duty;
  for (int k = 0; k < measurements; ++k) {
    table.exposure_s[k] = between(random, 0.01, 0.2);
    table.gain_e_per_raw[k] = between(random, 0.2, 5.0);
    table.black_level[k] = between(random, -50.0, 200.0);
    table.dark_electrons[k] = between(random, 0.0, 300.0);
    table.constant_variance_e2[k] = between(random, 0.0, 900.0);
  }
  return table;
}

TEST(UnequalMeasurements, DepthSignalAndAmbientAreRecoveredWithoutNoise) {
  constexpr double signal = 1e6, ambient = 3e4;
  for (std::uint64_t seed = 0; seed < repetitions(60u); ++seed) {
    RandomStream random(seed, 1);
    const Decoder decoder(random_table(random, 3 + static_cast<int>(seed % 4)));
    const DecodingTable& table = decoder.table();
    ASSERT_TRUE(ambiguous_depths(table).empty()) << seed;
    std::vector<float> raw;
    std::vector<double> truth;
    for (int i = 0; i < 50; ++i) {
      truth.push_back(table.samples() * random.uniform());
      append_pixel(table, signal, ambient, table.in_bins(truth.back()), nullptr, raw);
    }
    const DepthImage image = decoder.decode(frame_of(raw, table.measurements()));
    for (std::size_t i = 0; i < truth.size(); ++i) {
      ASSERT_NEAR(
          circular_difference(image.depth_m.pixels[i] / table.row_m(), truth[i], table.samples()),
          0.0, 2e-2)
          << seed;
      ASSERT_NEAR(image.signal_e_per_s.pixels[i], signal, 5e-3 * signal) << seed;
      ASSERT_NEAR(image.ambient_e_per_s.pixels[i], ambient, 5e-3 * signal) << seed;
    }
  }
}

TEST(UnequalMeasurements, GainAndOffsetAreCorrectedFirst) {
  // Powers of two and integers make a correction of the frame beforehand exact, so that bins are
  // equal and other planes equal up to rounding.
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  const DecodingTable& electrons = setup.decoder.table();
  DecodingTable counts = electrons;
  counts.gain_e_per_raw << 0.5, 2.0, 0.25, 4.0;
  counts.black_level << 64.0, -32.0, 7.0, 0.0;
  std::vector<float> corrected = noisy_pixels(electrons, 1e4, 1e4, 3000, 4);
  std::vector<float> raw;
  for (std::size_t i = 0; i < corrected.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i % 4);
    corrected[i] = std::round(corrected[i]);
    raw.push_back(
        static_cast<float>(corrected[i] / counts.gain_e_per_raw[k] + counts.black_level[k]));
  }
  const Decoder of_counts(counts);
  const DepthImage expected = setup.decoder.decode(frame_of(corrected, 4));
  const DepthImage image = of_counts.decode(frame_of(raw, 4));
  EXPECT_EQ(bins_of(of_counts, raw), bins_of(setup.decoder, corrected));
  for (std::size_t i = 0; i < expected.depth_m.size(); ++i) {
    const double off_m =
        circular_difference(image.depth_m.pixels[i], expected.depth_m.pixels[i], electrons.range_m);
    ASSERT_LE(std::abs(off_m), 1e-4 * electrons.bin_m()) << i;
    ASSERT_NEAR(image.signal_e_per_s.pixels[i], expected.signal_e_per_s.pixels[i], 0.02) << i;
    ASSERT_NEAR(image.confidence.pixels[i], expected.confidence.pixels[i], 1e-5) << i;
    ASSERT_EQ(image.status.pixels[i], expected.status.pixels[i]) << i;
  }
}

/// Returns exclusive taps of random widths and a pulse wider than any of them.
CodeSet random_code_of_taps(RandomStream& random, int taps, int exposures) {
  std::vector<Waveform> light, gates;
  for (int e = 0; e < exposures; ++e) {
    const double pulse = between(random, 0.46, 0.56), start = random.uniform();
    light.push_back(Waveform::binary({{start, start + pulse}}, 1 / pulse));
    double from = random.uniform();
    const double whole = from + 1.0;
    for (int t = 0; t < taps; ++t) {
      const double to = t + 1 < taps ? from + (1.0 + between(random, -0.2, 0.2)) / taps : whole;
      const double turns = std::floor(from);
      gates.push_back(Waveform::binary({{from - turns, to - turns}}));
      from = to;
    }
  }
  return CodeSet::create("random", 120, taps, light, gates);
}

TEST(UnequalMeasurements, ThreeAndFourTapsOfUnequalDutyDecode) {
  for (const int taps : {3, 4})
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      RandomStream random(seed, 4);
      Camera camera = camera_with("paper-30x", taps);
      camera.samples = 120;
      camera.exposure_s.each_s = {0.03, 0.11};
      camera.sensor.dark_current_e_per_s = 500.0;
      const ForwardModel model(random_code_of_taps(random, taps, 2), camera);
      const Decoder decoder(make_decoding_table(model, camera));
      ASSERT_EQ(decoder.measurements(), 2 * taps);
      ASSERT_TRUE(ambiguous_depths(decoder.table()).empty()) << taps << " taps, seed " << seed;
      for (double z = 0.0; z < 120.0; z += 1.0) {
        const Return light{1e6, z};
        const Eigen::VectorXf raw = model.expected_electrons({&light, 1}, 2e5).cast<float>();
        double found = 0.0;
        decoder.decode_depth_bins(raw.data(), 1, &found);
        ASSERT_NEAR(circular_difference(found, z, 120), 0.0, 2e-3)
            << taps << " taps, seed " << seed << ", bin " << z;
      }
    }
}

}  // namespace
}  // namespace tofsmith
