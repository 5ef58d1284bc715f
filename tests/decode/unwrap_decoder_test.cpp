// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/unwrap_decoder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <complex>
#include <numbers>
#include <tuple>

#include "decode_setup.hpp"
#include "pixel_laws.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decode_method.hpp"

namespace tofsmith {

namespace {

constexpr const char* codes[] = {"sinusoid-k3",
                                 "sinusoid-k4",
                                 "multifrequency-k5",
                                 "multifrequency-1x4-7x4",
                                 "multifrequency-1x2-7x3",
                                 "multifrequency-3x3-4x3",
                                 "multifrequency-2x4-5x2",
                                 "multifrequency-1x3-5x3-12x3"};

double largest_error_bin(const UnwrapSetup& setup) {
  const int samples = setup.decoder.samples();
  RandomStream random(5, 0);
  std::vector<double> truth;
  std::vector<float> raw;
  for (int i = 0; i < 100; ++i) {
    truth.push_back(samples * random.uniform());
    setup.append_expected(raw, 1e6, truth.back(), 1e4);
  }
  const std::vector<double> found = depth_bins_of(setup.decoder, raw);
  double largest = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    largest = std::max(largest, std::abs(circular_difference(found[i], truth[i], samples)));
  return largest;
}

TEST(UnwrapDecoder, RecoversEveryDepthWithoutNoise) {
  for (const char* code : codes)
    for (const Camera& camera :
         {camera_with("paper-30x"), camera_with("paper-30x", 2), camera_with("paper-10f0"),
          camera_with("paper-5f0"), camera_with("paper-10f0", 2, Readout::difference)}) {
      // The band limit of 5 f0 almost removes 7 f0; the rest is rounding error of single precision.
      const double most = camera.name == "paper-5f0" ? 0.2 : 2e-3;
      for (const UnwrapWeights weights : {UnwrapWeights::variance, UnwrapWeights::frequency})
        EXPECT_LT(largest_error_bin(UnwrapSetup(code, camera, {.weights = weights})), most)
            << code << " on " << camera.name << ", " << camera.sensor.taps << " taps, "
            << name_of(weights);
    }
}

TEST(UnwrapDecoder, RecoversEveryDepthFromTwoPhasesIfAmbientLightCancels) {
  EXPECT_LT(largest_error_bin(UnwrapSetup("multifrequency-1x2-7x2",
                                          camera_with("paper-30x", 2, Readout::difference))),
            2e-3);
}

TEST(UnwrapDecoder, RecoversEveryDepthOfAnyCamera) {
  Camera camera = camera_with("paper-10f0");
  camera.exposure_s.each_s = {0.02, 0.05, 0.1, 0.03, 0.13};
  camera.sensor.dark_current_e_per_s = 3e3;
  // A low-pass shifts the phase of every frequency differently.
  camera.light.impulse_response = {.kind = ImpulseResponse::Kind::lowpass, .cutoff_hz = 40e6};
  EXPECT_LT(largest_error_bin(UnwrapSetup("multifrequency-k5", camera)), 2e-3);
  camera.light.peak_factor = 1.3;  // modulation depth 30 %
  EXPECT_LT(largest_error_bin(UnwrapSetup("multifrequency-k5", camera)), 5e-3);
  camera.sensor.taps = 2;
  camera.sensor.modulation_contrast = 0.7;
  EXPECT_LT(largest_error_bin(UnwrapSetup("multifrequency-k5", camera)), 5e-3);
}

TEST(UnwrapDecoder, FindsTheFrequenciesInTheCodeItself) {
  const UnwrapSetup setup("multifrequency-k5", camera_with("paper-30x"));
  EXPECT_EQ(setup.decoder.frequencies(), (std::vector<int>{1, 7}));
  const UnwrapSetup three("multifrequency-1x3-5x3-12x3", camera_with("paper-10f0"));
  EXPECT_EQ(three.decoder.frequencies(), (std::vector<int>{1, 5, 12}));
}

TEST(UnwrapDecoder, WeighsFrequenciesByTheirVariance) {
  // With equal steps and no band limit, the noise is equal and weights are proportional to f^2.
  const UnwrapSetup even("multifrequency-1x4-7x4", camera_with("paper-30x"));
  EXPECT_NEAR(even.decoder.weights()[1] / even.decoder.weights()[0], 49.0, 0.1);
  const Camera camera = camera_with("paper-10f0");
  const UnwrapSetup limited("multifrequency-1x4-7x4", camera);
  const Eigen::VectorXcd transfer = camera.transfer(7);
  EXPECT_NEAR(limited.decoder.weights()[1] / limited.decoder.weights()[0],
              49.0 * std::norm(transfer[7]) / std::norm(transfer[1]), 0.1);
  const UnwrapSetup classical("multifrequency-1x4-7x4", camera,
                              {.weights = UnwrapWeights::frequency});
  EXPECT_NEAR(classical.decoder.weights()[1] / classical.decoder.weights()[0], 49.0, 1e-9);
}

TEST(UnwrapDecoder, ASingleFrequencyDecodesLikeZncc) {
  for (const char* code : {"sinusoid-k3", "sinusoid-k4", "sinusoid-k7"})
    for (const int taps : {1, 2}) {
      const UnwrapSetup unwrap(code, camera_with("paper-10f0", taps));
      const DecodeSetup zncc(code, camera_with("paper-10f0", taps));
      const std::vector<float> raw = noisy_pixels(zncc.decoder.table(), 3e3, 1e4, 5000, 2);
      const auto a = depth_bins_of(unwrap.decoder, raw), b = depth_bins_of(zncc.decoder, raw);
      for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_NEAR(circular_difference(a[i], b[i], 240), 0.0, 1e-3) << code;
    }
}

/// Reference: weighted distance of a depth [periods] from the nearest candidates of 3 steps at f0
/// and a quadrature pair at 7 f0, from textbook formulas.
struct PlainDistance {
  double phase1, phase7, weight1, weight7;

  PlainDistance(const float* y, double weight1_, double weight7_)
      : weight1(weight1_), weight7(weight7_) {
    const double turn = 2 * std::numbers::pi;
    const double offset = (y[0] + y[1] + y[2]) / 3.0;
    std::complex<double> q1;
    for (int k = 0; k < 3; ++k) q1 += static_cast<double>(y[k]) * std::polar(1.0, turn * k / 3);
    phase1 = std::arg(q1) / turn;
    phase7 = std::atan2(y[4] - offset, y[3] - offset) / turn;
  }
  double operator()(double z) const {
    const double d1 = circular_difference(z, phase1, 1.0);
    const double d7 = circular_difference(7 * z, phase7, 1.0) / 7;
    return weight1 * d1 * d1 + weight7 * d7 * d7;
  }
};

TEST(UnwrapDecoder, AgreesWithAnExhaustiveSearchOfTheWeightedDistance) {
  for (const UnwrapWeights weights : {UnwrapWeights::variance, UnwrapWeights::frequency}) {
    const UnwrapSetup setup("multifrequency-k5", camera_with("paper-30x"), {.weights = weights});
    for (const double signal : {5e2, 3e3, 3e4}) {
      const std::vector<float> raw = noisy_pixels(setup.decoder.table(), signal, 1e4, 100, 4);
      const std::vector<double> found = depth_bins_of(setup.decoder, raw);
      for (std::size_t i = 0; i < found.size(); ++i) {
        const PlainDistance distance(&raw[5 * i], setup.decoder.weights()[0],
                                     setup.decoder.weights()[1]);
        constexpr int grid = 12000;
        int best = 0;
        for (int n = 1; n < grid; ++n)
          if (distance(n / double{grid}) < distance(best / double{grid})) best = n;
        ASSERT_LE(distance(found[i] / 240), distance(best / double{grid}) + 1e-9);
        ASSERT_NEAR(distance(found[i] / 240), distance(best / double{grid}), 1e-6);
        ASSERT_LT(std::abs(circular_difference(found[i] / 240, best / double{grid}, 1.0)),
                  1.0 / grid);
      }
    }
  }
}

TEST(UnwrapDecoder, AmbientLightAndScaleLeaveDepthUnchanged) {
  const UnwrapSetup setup("multifrequency-k5", camera_with("paper-10f0"));
  std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e4, 1e4, 2000, 7);
  for (float& value : raw) value = std::round(value);
  std::vector<float> brighter = raw, scaled = raw;
  for (float& value : brighter) value += 30000.0f;
  for (float& value : scaled) value *= 3.0f;
  const auto a = depth_bins_of(setup.decoder, raw);
  const auto b = depth_bins_of(setup.decoder, brighter), c = depth_bins_of(setup.decoder, scaled);
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_NEAR(circular_difference(a[i], b[i], 240), 0.0, 1e-6);
    ASSERT_NEAR(circular_difference(a[i], c[i], 240), 0.0, 1e-6);
  }
}

TEST(UnwrapDecoder, PermutingMeasurementsLeavesDepthUnchanged) {
  const UnwrapSetup setup("multifrequency-k5", camera_with("paper-10f0"));
  const std::array order = {3, 0, 4, 2, 1};
  DecodingTable permuted = setup.decoder.table();
  for (int k = 0; k < 5; ++k)
    permuted.correlation.col(k) =
        setup.decoder.table().correlation.col(order[static_cast<std::size_t>(k)]);
  const UnwrapDecoder other(permuted);
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e4, 1e4, 2000, 7);
  std::vector<float> permuted_raw(raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i)
    permuted_raw[i] = raw[i / 5 * 5 + static_cast<std::size_t>(order[i % 5])];
  const auto a = depth_bins_of(setup.decoder, raw), b = depth_bins_of(other, permuted_raw);
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_NEAR(circular_difference(a[i], b[i], 240), 0.0, 1e-6);
}

TEST(UnwrapDecoder, RotatingTheOriginRotatesDepth) {
  const Camera camera = camera_with("paper-10f0");
  const CodeSet code = build_family("multifrequency-k5", camera);
  const UnwrapDecoder decoder(make_decoding_table(ForwardModel(code, camera), camera));
  const UnwrapDecoder rotated(make_decoding_table(ForwardModel(code.rotated(33), camera), camera));
  const std::vector<float> raw = noisy_pixels(decoder.table(), 1e4, 1e4, 500, 3);
  const auto a = depth_bins_of(decoder, raw), b = depth_bins_of(rotated, raw);
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_NEAR(circular_difference(a[i] - 33, b[i], 240), 0.0, 1e-6);
}

std::string refusal_of(const std::string& code, const Camera& camera) {
  try {
    UnwrapSetup setup(code, camera);
    return "accepted";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(UnwrapDecoder, RejectsNonSinusoidalCodesWithTheirDeviation) {
  const Camera camera = camera_with("paper-30x");
  const std::string square = refusal_of("square-k4", camera);
  EXPECT_NE(square.find("correlation of measurement 0 = 1.45 % of its energy outside harmonic 1"),
            std::string::npos)
      << square;
  for (const char* code : {"hamiltonian-k4", "pulsed-multifrequency-k5", "gray-k4"})
    EXPECT_NE(refusal_of(code, camera).find("requires sinusoids"), std::string::npos) << code;
  // Nearly sinusoidal codes are accepted on request.
  EXPECT_LT(largest_error_bin(UnwrapSetup("square-k4", camera, {.largest_other_energy = 0.02})),
            3.0);
}

TEST(UnwrapDecoder, RejectsAmbiguousFrequencies) {
  const Camera camera = camera_with("paper-30x");
  EXPECT_EQ(
      refusal_of("multifrequency-2x3-6x3", camera),
      "frequencies = 2, 6; must have no common divisor: depth repeats after 4.997 of 9.993 m");
  EXPECT_EQ(refusal_of("multifrequency-1x2-7x2", camera),
            "measurements = 4; must determine 5 unknowns (two per frequency and 1 for the offset "
            "of signal and ambient light); use 3 phases for one frequency");
  DecodingTable table = decoding_table_of("multifrequency-1x3-7x3", camera);
  table.correlation.col(4) = table.correlation.col(3);
  table.correlation.col(5) = (1.0 - table.correlation.col(3).array()).matrix();
  try {
    UnwrapDecoder decoder(table);
    FAIL() << "7 f0 is seen in one phase and its opposite";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "phases of harmonic 7 = one; must be two or more that are not half a period "
                 "apart");
  }
  EXPECT_THROW(UnwrapOptions({.largest_other_energy = 2.0}).validate(), std::invalid_argument);
}

TEST(UnwrapDecoder, StrongSignalIsOk) {
  expect_strong_signal_is_ok(UnwrapSetup("multifrequency-k5", camera_with("paper-10f0")), 1e6, 2e3,
                             1e3);
}

TEST(UnwrapDecoder, NaNIsInvalidAndDoesNotAffectNeighbours) {
  expect_not_a_number_disturbs_no_neighbour(
      UnwrapSetup("multifrequency-k5", camera_with("paper-10f0")).decoder, 20);
}

TEST(UnwrapDecoder, PixelsWithoutReliableDepthAreMarked) {
  expect_statuses_of_bad_pixels<UnwrapSetup>("multifrequency-k5");
}

TEST(UnwrapDecoder, RejectsFramesOfAnotherCode) {
  const UnwrapSetup setup("multifrequency-k5", camera_with("paper-10f0"));
  EXPECT_THROW(setup.decoder.decode(frame_of(std::vector<float>(8, 1.0f), 4)),
               std::invalid_argument);
}

TEST(UnwrapDecoder, DeviationAgreesWithMonteCarloAtHighSignal) {
  constexpr auto variance = UnwrapWeights::variance, frequency = UnwrapWeights::frequency;
  const Camera two_buckets = camera_with("paper-10f0", 2, Readout::difference);
  for (const auto& [code, camera, weights] :
       {std::tuple{"sinusoid-k4", camera_with("paper-10f0"), variance},
        {"multifrequency-k5", camera_with("paper-30x"), variance},
        {"multifrequency-k5", camera_with("paper-10f0"), frequency},
        {"multifrequency-1x4-7x4", camera_with("paper-10f0", 2), variance},
        {"multifrequency-1x3-5x3", two_buckets, variance}}) {
    const UnwrapSetup setup(code, camera, {.weights = weights});
    for (const double truth_bin : {33.3, 121.7, 200.2})
      EXPECT_NEAR(estimates_at(setup, truth_bin, 1e6, 1e4).ratio(), 1.0, 0.06)
          << code << " at " << truth_bin;
  }
}

TEST(DecodeMethod, HasAName) {
  for (const DecodeMethod method : all_values<DecodeMethod>)
    EXPECT_EQ(parse_decode_method(name_of(method)), method);
  for (const UnwrapWeights weights : {UnwrapWeights::variance, UnwrapWeights::frequency})
    EXPECT_EQ(parse_unwrap_weights(name_of(weights)), weights);
  EXPECT_THROW(parse_decode_method("magic"), std::invalid_argument);
  EXPECT_THROW(parse_unwrap_weights("magic"), std::invalid_argument);
}

}  // namespace

}  // namespace tofsmith
