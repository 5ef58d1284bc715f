// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/chips/chip_judge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "chip_setup.hpp"
#include "core/shared/random.hpp"
#include "tofsmith/simulate/bounds.hpp"

namespace tofsmith {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const OperatingPoint high{1.7e7, 0.0}, low_ambient{1.7e7, 8e7}, low_signal{1.1e6, 0.0};

Camera nine_chips() { return built_in_camera("exclusive-3tap-9chip"); }

Camera camera_for(const ChipCode& code, Camera camera) {
  camera.sensor.taps = code.taps;
  camera.sensor.shortest_pulse_s = 1.0 / (camera.fundamental_frequency_hz * code.chips);
  camera.samples = (camera.samples + code.chips - 1) / code.chips * code.chips;
  return camera;
}

ChipCode code_of(std::vector<std::vector<std::string>> exposures) {
  ChipCode code{static_cast<int>(exposures.front().front().size()),
                static_cast<int>(exposures.front().size()) - 1,
                {},
                {}};
  for (const auto& words : exposures) {
    code.modulation.push_back(chip_word(words.front()));
    for (std::size_t i = 1; i < words.size(); ++i) code.demodulation.push_back(chip_word(words[i]));
  }
  return code;
}

ChipCode three_phase() { return code_of({{"111000000", "111000000", "000111000", "000000111"}}); }

ChipCode random_code(int chips, int taps, int exposures, std::uint64_t seed) {
  RandomStream random(seed, 0);
  ChipCode code{chips, taps, {}, {}};
  for (int e = 0; e < exposures; ++e) {
    code.modulation.push_back(1 + random() % (all_chips(chips) - 1));
    std::vector<ChipWord> words(static_cast<std::size_t>(taps), 0);
    for (int k = 0; k < chips; ++k) {
      const auto tap = static_cast<std::size_t>(random() % static_cast<unsigned>(taps + 1));
      if (tap < words.size()) words[tap] |= ChipWord{1} << k;
    }
    code.demodulation.insert(code.demodulation.end(), words.begin(), words.end());
  }
  return code;
}

/// Reference: whitened distance between two depths, minimized over the light of the second, from
/// the forward model.
double distance(const ChipCode& code, const Camera& camera, const OperatingPoint& point, double z,
                double alternative) {
  const ForwardModel model(to_code_set(code, camera, "code"), camera);
  const Return returned{point.signal_e_per_s, z * camera.samples / code.chips};
  const Eigen::VectorXd mean = model.expected_electrons({&returned, 1}, point.ambient_e_per_s);
  const Eigen::ArrayXd weight =
      model.variance_e2({&returned, 1}, point.ambient_e_per_s).array().rsqrt();
  Eigen::VectorXd ambient = (weight * model.ambient_gain().array()).matrix();
  ambient.normalize();
  const auto whitened = [&](const Eigen::VectorXd& values) {
    Eigen::VectorXd w = (weight * values.array()).matrix();
    w -= w.dot(ambient) * ambient;
    return w;
  };
  const Eigen::VectorXd truth = whitened(mean);
  const Eigen::VectorXd other =
      whitened(model.correlation(alternative * camera.samples / code.chips));
  const double signal = std::max(0.0, truth.dot(other) / std::max(1e-300, other.squaredNorm()));
  return (truth - signal * other).norm();
}

TEST(ChipMetric, EqualsTheCramerRaoBoundOfTheCode) {
  for (const double peak_factor : {1.0, 2.5}) {
    Camera camera = nine_chips();
    camera.samples = 360;
    camera.light.peak_factor = peak_factor;
    for (const ChipCode& code :
         {three_phase(), code_of({{"101010100", "101010000", "000101010", "010000101"},
                                  {"100100100", "100100100", "010010010", "001001001"}})}) {
      const ForwardModel model(to_code_set(code, camera, "code"), camera);
      for (const OperatingPoint& point : {high, low_ambient, low_signal}) {
        const double bound =
            std::sqrt(CramerRaoBound(model, camera).sigma_m(point).squaredNorm() / (4.0 * 360));
        EXPECT_NEAR(chip_metric_rms_m(code, camera, point), bound, 2e-4 * bound) << code.text();
      }
    }
  }
}

TEST(ChipMetric, IsTheErrorOfDepthAloneIfLightIsKnown) {
  const ChipCode code = three_phase();
  const Camera camera = nine_chips();
  const ForwardModel model(to_code_set(code, camera, "code"), camera);
  const double range_m = camera.range_m();
  double mean_variance = 0.0;
  constexpr int depths = 9 * 64;
  for (int n = 0; n < depths; ++n) {
    const auto mean_at = [&](double place) {
      const Return returned{low_ambient.signal_e_per_s, place * camera.samples / depths};
      return model.expected_electrons({&returned, 1}, low_ambient.ambient_e_per_s);
    };
    const Return here{low_ambient.signal_e_per_s, (n + 0.5) * camera.samples / depths};
    const Eigen::ArrayXd slope =
        (mean_at(n + 0.75) - mean_at(n + 0.25)).array() / (0.5 * range_m / depths);
    const Eigen::ArrayXd variance =
        model.variance_e2({&here, 1}, low_ambient.ambient_e_per_s).array();
    mean_variance += 1.0 / (slope.square() / variance).sum() / depths;
  }
  const double known_m = chip_metric_rms_m(code, camera, low_ambient, ChipMetric::known_light);
  EXPECT_NEAR(known_m, std::sqrt(mean_variance), 1e-3 * known_m);
  EXPECT_LT(known_m, chip_metric_rms_m(code, camera, low_ambient));
}

TEST(ChipMetric, IsInfiniteIfDepthAndLightAreInseparable) {
  const ChipCode same_taps = code_of({{"1100", "1000", "0010"}, {"1100", "1000", "0010"}});
  Camera camera = camera_for(same_taps, nine_chips());
  EXPECT_EQ(chip_metric_rms_m(same_taps, camera, high), std::numeric_limits<double>::infinity());
}

TEST(ChipMetric, IsInvariantToDelaysReflectionsAndOrder) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    ChipCode code = random_code(9, 3, 2, seed);
    const double rms_m = chip_metric_rms_m(code, nine_chips(), low_ambient);
    const bool is_ambiguous_code = is_ambiguous(code);
    for (ChipWord& word : code.modulation) word = delayed_chips(reversed_chips(word, 9), 2, 9);
    for (ChipWord& word : code.demodulation) word = delayed_chips(reversed_chips(word, 9), 5, 9);
    std::swap(code.demodulation[0], code.demodulation[2]);
    const double moved_rms_m = chip_metric_rms_m(code, nine_chips(), low_ambient);
    EXPECT_EQ(std::isfinite(moved_rms_m), std::isfinite(rms_m));
    if (std::isfinite(rms_m)) {
      EXPECT_NEAR(moved_rms_m, rms_m, 1e-9 * rms_m);
    }
    EXPECT_EQ(is_ambiguous(code), is_ambiguous_code);
  }
}

TEST(ChipAmbiguity, FollowsFromTurningAndWindingNumberForThreeTaps) {
  // With one exposure of three taps, directions lie in a plane: they are unique if they always turn
  // the same way and wind around once.
  int unambiguous = 0;
  const auto agrees = [&](const ChipCode& code) {
    double turned = 0.0;
    int left = 0, right = 0;
    const auto along = [&](int s) {
      const double a = code.correlation(0, s), b = code.correlation(1, s),
                   c = code.correlation(2, s);
      return Eigen::Vector2d(a - (b + c) / 2, std::sqrt(0.75) * (b - c));
    };
    for (int s = 0; s < code.chips; ++s) {
      const Eigen::Vector2d here = along(s), next = along(s + 1);
      const double cross = here.x() * next.y() - here.y() * next.x();
      if (cross > 1e-9) ++left;
      if (cross < -1e-9) ++right;
      turned += std::atan2(cross, here.dot(next));
    }
    const bool is_once = std::abs(std::abs(turned) - 2 * std::numbers::pi) < 1e-6;
    const bool is_plain = is_once && std::max(left, right) == code.chips;
    unambiguous += is_plain ? 1 : 0;
    return is_ambiguous(code) == !is_plain;
  };
  for (const ChipWord light : {0b1U, 0b11U, 0b111U, 0b1111U, 0b10011U, 0b1001U, 0b101U, 0b11011U})
    for (const char* first : {"110000", "101000", "100000"})
      for (ChipWord second = 1; second < 64; ++second)
        for (ChipWord third = 1; third < 64; ++third) {
          const ChipCode code{6, 3, {light}, {chip_word(first), second, third}};
          if ((code.demodulation[0] & second) != 0 ||
              ((code.demodulation[0] | second) & third) != 0)
            continue;
          const int duty = std::popcount(code.demodulation[0]);
          if (std::popcount(second) != duty || std::popcount(third) != duty) continue;
          ASSERT_TRUE(agrees(code)) << code.text();
        }
  EXPECT_EQ(unambiguous, 8);
}

TEST(ChipAmbiguity, FindsCrossingsBetweenWholeChips) {
  // Here all whole chips differ, but two stretches between them intersect.
  int crossings = 0;
  for (std::uint64_t seed = 1; seed <= 400 && crossings < 3; ++seed) {
    const ChipCode code = random_code(9, 4, 1, seed);
    if (!is_ambiguous(code)) continue;
    Camera camera = camera_for(code, nine_chips());
    const double margin = ambiguity_margin_sigma(code, camera, high);
    double corners = std::numeric_limits<double>::infinity();
    for (int s = 0; s < 9; ++s)
      for (int u = 0; u < s; ++u) corners = std::min(corners, distance(code, camera, high, s, u));
    if (corners < 20.0) continue;
    ++crossings;
    EXPECT_LT(margin, corners) << code.text();
  }
  EXPECT_GT(crossings, 0);
}

TEST(ChipMargin, IsTheSmallestDistanceOverPairsOfDepths) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const ChipCode code = seed == 1 ? three_phase() : random_code(6, 3, 2, seed);
    const Camera camera = camera_for(code, nine_chips());
    const double separation = 1.0 / 12;
    const double margin = ambiguity_margin_sigma(code, camera, low_ambient, separation);
    double sampled = std::numeric_limits<double>::infinity();
    constexpr int per_chip = 4;
    const int all = code.chips * per_chip;
    for (int i = 0; i < all; ++i)
      for (int j = 0; j < all; ++j) {
        const int apart = std::min(std::abs(i - j), all - std::abs(i - j));
        if (apart < separation * all) continue;
        sampled = std::min(sampled, distance(code, camera, low_ambient, double(i) / per_chip,
                                             double(j) / per_chip));
      }
    EXPECT_LE(margin, sampled * (1 + 1e-9)) << code.text();
    // The samples are dense enough to come near the minimum, except at intersections.
    if (!is_ambiguous(code)) {
      EXPECT_GE(margin, 0.6 * sampled) << code.text();
    }
  }
}

TEST(ChipMargin, IsExactWhereFourSamplesPerChipAreTooFew) {
  // Sampled at four depths per chip, the margin of this code appears to be 8 sigma; the true
  // minimum is smaller.
  const ChipCode code = code_of({{"110101010", "101010000", "000101010", "010000101"},
                                 {"100100100", "100100100", "010010010", "001001001"}});
  const double margin = ambiguity_margin_sigma(code, nine_chips(), low_signal);
  EXPECT_LT(margin, 7.9);
  EXPECT_GT(margin, 7.8);
}

TEST(ChipCode, RejectsInvalidCodesAndCameras) {
  EXPECT_THAT(
      [] {
        code_of({{"1100", "1000", "1000", "0010"}}).validate();
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("must not overlap")));
  EXPECT_THAT([] { chip_word("1x0"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("digits 0 and 1")));
  Camera camera = nine_chips();
  camera.sensor.shortest_pulse_s = 11e-9;
  EXPECT_THAT([&] { chips_of(camera); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("integer")));
  camera = nine_chips();
  camera.sensor.modulation_contrast = 0.9;
  EXPECT_THAT([&] { chip_metric_rms_m(three_phase(), camera, high); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("modulation_contrast")));
}

TEST(ChipCode, KeepsItsCorrelationsAsWaveforms) {
  const ChipCode code = random_code(9, 3, 2, 7);
  const CodeSet set = to_code_set(code, nine_chips(), "code");
  EXPECT_NO_THROW(require_fits(set, nine_chips()));
  const ForwardModel model(set, nine_chips());
  for (int s = 0; s < 9; ++s) {
    const Eigen::VectorXd chi = model.correlation(s * 20.0);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(chi[i], code.correlation(i, s) / 9.0, 1e-12);
  }
}

}  // namespace
}  // namespace tofsmith
