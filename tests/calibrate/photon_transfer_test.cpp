// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/photon_transfer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

Camera known_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.exposure_s.total_s = 4e-3;
  camera.sensor.adc_bits = 12;
  camera.sensor.gain_e_per_dn = 7.5;
  camera.sensor.black_level_dn = 64.0;
  camera.sensor.read_noise_e = 28.0;
  return camera;
}

RawFrames frames_of(const Camera& camera, double ambient_e_per_s, std::uint64_t seed) {
  SceneImage scene(24, 24);
  scene.ambient_scale = Image<float>(24, 24, 1.0f);
  for (int row = 0; row < 24; ++row)
    for (int column = 0; column < 24; ++column)
      scene.ambient_scale(row, column) = 0.7f + 0.025f * static_cast<float>(column);
  return capture(
      scene, build_family("sinusoid-k4", camera), camera,
      {.signal_e_per_s = 0.0, .ambient_e_per_s = ambient_e_per_s, .seed = seed, .frames = 2});
}

PhotonTransfer calibrated(const Camera& camera, std::uint64_t seed, double brightest = 2e7,
                          const PhotonTransferOptions& options = {.adc_bits = 12}) {
  std::vector<RawFrames> levels;
  for (int i = 1; i <= 6; ++i)
    levels.push_back(frames_of(camera, brightest * i / 6, 100 * seed + static_cast<unsigned>(i)));
  return photon_transfer(levels, frames_of(camera, 0.0, 100 * seed), options);
}

/// Expects the gain, read noise and black level of known_camera() with correct standard errors.
/// @param found_of  returns the calibration of a seed
template <typename Found>
void expect_known_sensor(const Found& found_of, bool has_black_level) {
  constexpr int seeds = 12;
  std::array<double, 3> chi2{};  // reduced, 12 degrees of freedom
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const PhotonTransfer found = found_of(seed);
    const auto square = [&](const Estimate& e, double truth) {
      EXPECT_NEAR(e.value, truth, 4 * e.standard_error) << "seed " << seed;
      return std::pow((e.value - truth) / e.standard_error, 2) / seeds;
    };
    chi2[0] += square(found.gain_e_per_dn, 7.5);
    chi2[1] += square(found.read_noise_e, 28.0);
    if (has_black_level) chi2[2] += square(found.black_level_dn, 64.0);
    EXPECT_LT(found.gain_e_per_dn.standard_error, 0.02 * 7.5);
    EXPECT_LT(found.read_noise_e.standard_error, 0.05 * 28.0);
    EXPECT_FALSE(found.full_well_e);
  }
  for (std::size_t i = 0; i < (has_black_level ? 3u : 2u); ++i) {
    EXPECT_GT(chi2[i], 0.25);
    EXPECT_LT(chi2[i], 2.7);
  }
}

TEST(PhotonTransfer, RecoversAKnownSensorWithCorrectStandardErrors) {
  const Camera camera = known_camera();
  expect_known_sensor([&](std::uint64_t seed) { return calibrated(camera, seed); }, true);
}

TEST(PhotonTransfer, FindsTheFullWellAndExcludesSaturatedFrames) {
  Camera camera = known_camera();
  camera.sensor.full_well_e = 12000.0;  // DN 1664, below the converter's 4095
  const PhotonTransfer found = calibrated(camera, 3, 5e7);
  ASSERT_TRUE(found.full_well_e);
  EXPECT_NEAR(found.full_well_e->value, 12000.0, 4 * found.full_well_e->standard_error);
  EXPECT_NEAR(found.gain_e_per_dn.value, 7.5, 4 * found.gain_e_per_dn.standard_error);
  EXPECT_TRUE(std::ranges::any_of(found.points, [](const auto& p) { return p.saturated; }));
  const Camera written = with_noise(built_in_camera("paper-10f0"), found);
  EXPECT_EQ(written.sensor.full_well_e, found.full_well_e->value);
  EXPECT_EQ(written.sensor.adc_bits, 12);
}

TEST(PhotonTransfer, ReportsWhenTheConverterSaturatesFirst) {
  Camera camera = known_camera();
  camera.sensor.adc_bits = 11;
  const PhotonTransfer found = calibrated(camera, 4, 8e7, {});
  EXPECT_EQ(found.adc_bits, 12);  // 2047 is none of the usual 8, 10, 12, ... bits
  const PhotonTransfer with_bits = calibrated(camera, 4, 8e7, {.adc_bits = 11});
  EXPECT_FALSE(with_bits.full_well_e);
  EXPECT_THAT(with_bits.notes, testing::Contains(HasSubstr("maximum 2047")));
}

TEST(PhotonTransfer, ReportsMissingInput) {
  const Camera camera = known_camera();
  RawFrames one = frames_of(camera, 1e6, 1);
  EXPECT_THROW(photon_transfer({one}, {}), std::invalid_argument);  // no black level
  EXPECT_THROW(photon_transfer({}, one), std::invalid_argument);
  const RawFrames dark = frames_of(camera, 0.0, 2);
  EXPECT_THROW(photon_transfer({dark}, dark), std::invalid_argument);  // no light
  one.frames = 1;
  one.values.resize(one.values.size() / 2);
  EXPECT_THROW(photon_transfer({one}, dark), std::invalid_argument);
}

Camera difference_camera() {
  Camera camera = known_camera();
  camera.sensor.taps = 2;
  camera.sensor.readout = Readout::difference;
  return camera;
}

DecodingTable table_of(const Camera& camera) {
  return make_decoding_table(ForwardModel(build_family("sinusoid-k4", camera), camera), camera);
}

/// Two frames of a slanted plane with many albedos, without ambient light.
RawFrames differences_of(const Camera& camera, double signal_e_per_s, std::uint64_t seed) {
  SceneImage scene(32, 32);
  for (int row = 0; row < 32; ++row)
    for (int column = 0; column < 32; ++column) {
      scene.depth_m(row, column) = 1.5f + 0.05f * static_cast<float>(row);
      scene.albedo(row, column) = 0.3f + 0.02f * static_cast<float>(column);
    }
  return capture(scene, build_family("sinusoid-k4", camera), camera,
                 {.signal_e_per_s = signal_e_per_s,
                  .ambient_e_per_s = 0.0,
                  .reference_distance_m = 2.0,
                  .seed = seed,
                  .frames = 2});
}

TEST(PhotonTransfer, OfDifferencesEqualsThatOfTheTaps) {
  const Camera camera = difference_camera();
  const DecodingTable table = table_of(camera);
  const auto found_of = [&](std::uint64_t seed) {
    std::vector<RawFrames> levels;
    for (int i = 1; i <= 3; ++i)
      levels.push_back(differences_of(camera, 8e6 * i, 100 * seed + static_cast<unsigned>(i)));
    return photon_transfer(levels, differences_of(camera, 0.0, 100 * seed), table,
                           {.adc_bits = 12});
  };
  expect_known_sensor(found_of, false);
  const PhotonTransfer found = found_of(1);
  EXPECT_EQ(found.buckets, 2);
  EXPECT_EQ(with_noise(camera, found).sensor.black_level_dn, camera.sensor.black_level_dn);
}

TEST(PhotonTransfer, OfMeansEqualsThatOfSingleFrames) {
  const Camera camera = known_camera();
  constexpr int averaged = 4;
  std::vector<RawFrames> levels;
  for (std::uint64_t level = 0; level <= 6; ++level) {
    RawFrames mean = frames_of(camera, 3e6 * static_cast<double>(level), 1000 * level);
    for (std::uint64_t i = 1; i < averaged; ++i) {
      const RawFrames more = frames_of(camera, 3e6 * static_cast<double>(level), 1000 * level + i);
      for (std::size_t at = 0; at < mean.values.size(); ++at) mean.values[at] += more.values[at];
    }
    for (float& value : mean.values) value /= averaged;
    levels.push_back(std::move(mean));
  }
  const RawFrames dark = levels.front();
  levels.erase(levels.begin());
  const PhotonTransfer found =
      photon_transfer(levels, dark, {.adc_bits = 12, .averaged = averaged});
  EXPECT_NEAR(found.gain_e_per_dn.value, 7.5, 4 * found.gain_e_per_dn.standard_error);
  EXPECT_NEAR(found.read_noise_e.value, 28.0, 4 * found.read_noise_e.standard_error);
}

TEST(PhotonTransfer, OfDifferencesToleratesChangingLight) {
  const Camera camera = difference_camera();
  const DecodingTable table = table_of(camera);
  std::vector<RawFrames> levels{differences_of(camera, 2e7, 1)};
  const RawFrames dark = differences_of(camera, 0.0, 2);
  const PhotonTransfer steady = photon_transfer(levels, dark, table, {.adc_bits = 12});
  float* second = levels[0].frame(1);
  for (std::size_t i = 0; i < levels[0].values.size() / 2; ++i) second[i] *= 0.97f;
  const PhotonTransfer weaker = photon_transfer(levels, dark, table, {.adc_bits = 12});
  EXPECT_NEAR(weaker.gain_e_per_dn.value, steady.gain_e_per_dn.value, 0.05 * 7.5);
}

TEST(PhotonTransfer, OfDifferencesExcludesClippedBuckets) {
  const Camera camera = difference_camera();
  const DecodingTable table = table_of(camera);
  const std::vector<RawFrames> levels{differences_of(camera, 1e7, 1),
                                      differences_of(camera, 6e7, 3)};
  const RawFrames dark = differences_of(camera, 0.0, 2);
  const PhotonTransfer found =
      photon_transfer(levels, dark, table, {.black_level_dn = 64.0, .adc_bits = 12});
  EXPECT_NEAR(found.gain_e_per_dn.value, 7.5, 4 * found.gain_e_per_dn.standard_error);
  EXPECT_THAT(found.notes, testing::Contains(HasSubstr("excluded, because one of their buckets")));
}

TEST(PhotonTransfer, OfDifferencesReportsMissingInput) {
  const Camera camera = difference_camera();
  const DecodingTable table = table_of(camera);
  const RawFrames dark = differences_of(camera, 0.0, 1), lit = differences_of(camera, 2e7, 2);
  EXPECT_THROW(photon_transfer({dark}, dark, table), std::invalid_argument);  // no light
  RawFrames short_of_one = lit;
  short_of_one.measurements = 3;
  short_of_one.values.resize(lit.values.size() / 4 * 3);
  EXPECT_THROW(photon_transfer({short_of_one}, {}, table), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
