// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Noise-free and noisy measurements at any real depth, compared with the continuous correlation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/shared/random.hpp"
#include "sanitizers.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/decode/likelihood_decoder.hpp"

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

std::vector<double> decoded_m(const Decoder& decoder, const std::vector<float>& raw) {
  const auto pixels = static_cast<int>(std::ssize(raw) / decoder.measurements());
  std::vector<float> depth_m(static_cast<std::size_t>(pixels));
  DecodedView planes;
  planes.depth_m = depth_m.data();
  decoder.decode(RawView::interleaved(raw.data(), 1, pixels, decoder.measurements()), planes);
  return {depth_m.begin(), depth_m.end()};
}

double largest_error_m(const Decoder& decoder, const Frequencies& list,
                       const std::vector<double>& contrast, int pixels, std::uint64_t seed) {
  RandomStream random(seed, 0);
  std::vector<float> raw;
  std::vector<double> truth_m;
  const double range_m = decoder.table().range_m;
  for (int i = 0; i < pixels; ++i) {
    const double periods = random.uniform();
    truth_m.push_back(periods * range_m);
    append_sinusoids(list, contrast, 1e4 * (0.1 + random.uniform()), periods, raw);
  }
  const std::vector<double> found_m = decoded_m(decoder, raw);
  double largest = 0.0;
  for (std::size_t i = 0; i < truth_m.size(); ++i)
    largest = std::max(largest, std::abs(circular_difference(found_m[i], truth_m[i], range_m)));
  return largest;
}

Decoder decoder_of(const std::string& code, const Camera& camera) {
  return Decoder(make_decoding_table(ForwardModel(build_family(code, camera), camera), camera));
}

class CloseWraps : public testing::TestWithParam<std::tuple<Frequencies, int>> {};

TEST_P(CloseWraps, DecodeEveryDepthWithoutNoiseAtAnyNumberOfSamples) {
  const auto& [list, samples] = GetParam();
  const Camera camera = two_bucket_camera(1e6, samples);
  const Decoder decoder = decoder_of(name_of(list), camera);
  EXPECT_EQ(decoder.samples(), samples);
  EXPECT_LT(largest_error_m(decoder, list, std::vector<double>(list.size(), 1.0), 250, 1), 2e-5);
}

INSTANTIATE_TEST_SUITE_P(
    Frequencies, CloseWraps,
    testing::Combine(testing::Values(Frequencies{{59, 4}, {60, 4}}, Frequencies{{83, 4}, {100, 4}},
                                     Frequencies{{63, 3}, {64, 2}}, Frequencies{{97, 4}, {100, 4}},
                                     Frequencies{{29, 4}, {30, 4}, {31, 4}},
                                     Frequencies{{150, 3}, {180, 3}, {200, 3}, {1, 2}},
                                     Frequencies{{399, 3}, {400, 5}}, Frequencies{{1, 4}, {2, 4}}),
                     testing::Values(8, 240)));

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
    const Camera camera = two_bucket_camera(1e6, 240);
    std::vector<double> contrast;
    for (std::size_t f = 0; f < list.size(); ++f) contrast.push_back(0.3 + 0.7 * random.uniform());
    EXPECT_LT(largest_error_m(decoder_of(name_of(list), camera), list, contrast, 100, 2), 2e-5)
        << name_of(list);
  }
}

TEST(Decoder, FindsDepthsWithoutNoiseForAnyContrastPerFrequency) {
  const Frequencies list = {{2, 3}, {10, 3}, {15, 3}};
  const Decoder kinect = decoder_of(name_of(list), built_in_camera("kinect-v2"));
  EXPECT_LT(largest_error_m(kinect, list, {1.0, 1.0 / 1.3226, 1.0 / 1.6129}, 500, 3), 5e-5);
  const Frequencies pair = {{1, 4}, {5, 4}};
  EXPECT_LT(largest_error_m(decoder_of(name_of(pair), two_bucket_camera(20e6, 240)), pair,
                            {1.0, 0.5}, 500, 3),
            5e-5);
}

TEST(LikelihoodDecoder, FindsDepthsWithoutNoiseForAnyContrastPerFrequency) {
  const Frequencies list = {{2, 3}, {10, 3}, {15, 3}};
  const Camera camera = built_in_camera("kinect-v2");
  const LikelihoodDecoder decoder(
      make_decoding_table(ForwardModel(build_family(name_of(list), camera), camera), camera));
  RandomStream random(3, 0);
  for (int i = 0; i < 300; ++i) {
    const double periods = random.uniform();
    std::vector<float> raw;
    append_sinusoids(list, {1.0, 1.0 / 1.3226, 1.0 / 1.6129}, 1e4, periods, raw);
    double found_bin = 0.0;
    decoder.decode_depth_bins(raw.data(), 1, &found_bin);
    const double error_bin =
        circular_difference(found_bin, periods * camera.samples, camera.samples);
    EXPECT_LT(std::abs(error_bin) * camera.bin_m(), 1e-4);
  }
}

/// Score <P y, P x(z)> / |P x(z)| of the forward model at any real depth.
class ContinuousScore {
 public:
  ContinuousScore(const ForwardModel& model, const DecodingTable& table)
      : model_(model), table_(table) {}

  double at(const float* raw, double depth_bin) const {
    const Eigen::VectorXd x = model_.correlation(depth_bin).cwiseProduct(table_.exposure_s);
    double along = 0.0;
    for (Eigen::Index k = 0; k < x.size(); ++k) along += raw[k] * x[k];
    return along / x.norm();
  }
  /// Grid search, then golden-section search at its best peaks.
  double best_bin(const float* raw, int points) const {
    const double step = static_cast<double>(table_.bin_count()) / points;
    std::vector<double> score(static_cast<std::size_t>(points));
    for (int i = 0; i < points; ++i) score[static_cast<std::size_t>(i)] = at(raw, i * step);
    const double least = 0.9 * *std::max_element(score.begin(), score.end());
    double best_score = -1.0, best = 0.0;
    for (int i = 0; i < points; ++i) {
      const double here = score[static_cast<std::size_t>(i)];
      if (here < least || here < score[static_cast<std::size_t>((i + 1) % points)] ||
          here < score[static_cast<std::size_t>((i + points - 1) % points)])
        continue;
      double left = (i - 1) * step, right = (i + 1) * step;
      for (int round = 0; round < 40; ++round) {
        const double a = left + 0.382 * (right - left), b = left + 0.618 * (right - left);
        (at(raw, a) > at(raw, b) ? right : left) = at(raw, a) > at(raw, b) ? b : a;
      }
      const double middle = 0.5 * (left + right);
      if (at(raw, middle) > best_score) best_score = at(raw, middle), best = middle;
    }
    return wrap(best, table_.bin_count());
  }

 private:
  const ForwardModel& model_;
  const DecodingTable& table_;
};

TEST(Decoder, ChoosesTheWrapOfTheContinuousCorrelationInNoise) {
  const Frequencies list = {{19, 4}, {20, 4}};
  const Camera camera = two_bucket_camera(1e6, 240);
  const ForwardModel model(build_family(name_of(list), camera), camera);
  const Decoder decoder(make_decoding_table(model, camera));
  const ContinuousScore score(model, decoder.table());
  RandomStream random(8, 0);
  std::vector<float> raw;
  constexpr int pixels = 60;
  int wrong = 0;
  for (int i = 0; i < pixels; ++i) {
    raw.clear();
    const double periods = random.uniform();
    append_sinusoids(list, {1.0, 1.0}, 1.0, periods, raw);
    for (float& value : raw) value += static_cast<float>(0.15 * random.normal());
    const double expected = score.best_bin(raw.data(), 2048);
    double found = 0.0;
    decoder.decode_depth_bins(raw.data(), 1, &found);
    EXPECT_NEAR(circular_difference(found, expected, 240.0), 0.0, 1e-3);
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
  const ForwardModel model(build_family("hamiltonian-k5", camera), camera);
  const Decoder decoder(make_decoding_table(model, camera));
  EXPECT_EQ(decoder.samples(), 100);
  for (int i = 0; i < 500; ++i) {
    const Return light{1e6, 0.2 * i + 0.05};
    const Eigen::VectorXf raw = model.expected_electrons({&light, 1}, 1e4).cast<float>();
    double found = 0.0;
    decoder.decode_depth_bins(raw.data(), 1, &found);
    EXPECT_NEAR(circular_difference(found, light.depth_bin, 100.0), 0.0, 1e-3);
  }
}

}  // namespace
}  // namespace tofsmith
