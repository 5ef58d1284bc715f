// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The kernel in single precision against the definition of every output in double.
#include "decode/output_kernel.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "decode/direction_table.hpp"
#include "decode/pixel_output.hpp"
#include "decode/raw_scale.hpp"
#include "decode_setup.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

constexpr auto tile_size = static_cast<std::size_t>(pixels_per_tile);

/// Runs `body` once for every instruction set this machine offers.
template <typename Body>
void for_each_target(const Body& body) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    SCOPED_TRACE(hwy::TargetName(target));
    body();
  }
  hwy::SetSupportedTargetsForTest(0);
}

/// All planes of a row of pixels.
struct Outputs {
  explicit Outputs(std::size_t pixels)
      : bin(pixels, -7),
        depth_m(pixels, -7.0f),
        signal(pixels, -7.0f),
        ambient(pixels, -7.0f),
        confidence(pixels, -7.0f),
        deviation_m(pixels, -7.0f),
        status(pixels, static_cast<PixelStatus>(77)) {}

  DecodedView view() {
    return {bin.data(),        depth_m.data(),     signal.data(), ambient.data(),
            confidence.data(), deviation_m.data(), status.data()};
  }

  std::vector<std::int32_t> bin;
  std::vector<float> depth_m, signal, ambient, confidence, deviation_m;
  std::vector<PixelStatus> status;
};

/// Whether floats are the same bits; NaN equals NaN.
testing::AssertionResult same(const std::vector<float>& a, const std::vector<float>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::memcmp(&a[i], &b[i], sizeof(float)) != 0)
      return testing::AssertionFailure() << a[i] << " != " << b[i] << " of pixel " << i;
  return testing::AssertionSuccess();
}

void expect_same(const Outputs& a, const Outputs& b) {
  EXPECT_EQ(a.bin, b.bin);
  EXPECT_TRUE(same(a.depth_m, b.depth_m));
  EXPECT_TRUE(same(a.signal, b.signal));
  EXPECT_TRUE(same(a.ambient, b.ambient));
  EXPECT_TRUE(same(a.confidence, b.confidence));
  EXPECT_TRUE(same(a.deviation_m, b.deviation_m));
  EXPECT_EQ(a.status, b.status);
}

/// A code's kernel, and pixels matched to bins in plain double arithmetic.
class Matched {
 public:
  Matched(const DecodingTable& table, const std::vector<float>& raw,
          const DecodeOptions& options = {})
      : table_(table),
        options_(options),
        projection_(table),
        directions_(projection_),
        model_(table, projection_),
        kernel_(table, projection_, options),
        scale_(table),
        raw_(raw),
        pixels_(raw.size() / k_count()) {
    const std::size_t tiles = (pixels_ + tile_size - 1) / tile_size;
    plane_.resize(tiles * rank() * tile_size);
    electrons_.resize(tiles * k_count() * tile_size);
    bin_.assign(tiles * tile_size, std::numeric_limits<std::int32_t>::max());
    rival_ = bin_;
    saturated_.resize(bin_.size());
    for (std::size_t i = 0; i < pixels_; ++i) match(i);
  }

  std::size_t pixels() const { return pixels_; }
  const OutputKernel& kernel() const { return kernel_; }

  MatchedTile tile(std::size_t first) const {
    return {static_cast<int>(std::min(pixels_ - first, tile_size)),
            &plane_[first * rank()],
            &electrons_[first * k_count()],
            &bin_[first],
            &rival_[first],
            &saturated_[first]};
  }

  void write(const DecodedView& planes) const {
    for (std::size_t first = 0; first < pixels_; first += tile_size)
      kernel_.write(tile(first), planes.from(first));
  }
  Outputs outputs() const {
    Outputs result(pixels_);
    write(result.view());
    return result;
  }

  /// The definition: PixelModel and store_pixel.
  Outputs expected() const {
    Outputs result(pixels_);
    for (std::size_t i = 0; i < pixels_; ++i) {
      if (bin_[i] < 0) {
        store_invalid(i, result.view());
        continue;
      }
      const PixelDecoding decoding = decoding_of(i);
      store_pixel(table_, options_, &raw_[i * k_count()], decoding, i, result.view());
    }
    return result;
  }

  PixelDecoding decoding_of(std::size_t i) const {
    std::array<double, max_measurements> variance_e2;
    const Eigen::VectorXd y = electrons(i), q = plane_of(y);
    const Position position = model_.refine(q.data(), bin_[i]);
    PixelDecoding decoding{position.in_bins(table_.samples()),
                           model_.estimate(y.data(), q.data(), position, variance_e2.data()), 1.0};
    if (rival_[i] >= 0) {
      const Eigen::VectorXd apart = direction(bin_[i]) - direction(rival_[i]);
      decoding.confidence =
          confidence_of(apart.dot(q), model_.deviation_along(apart.data(), variance_e2.data()));
    }
    return decoding;
  }

 private:
  std::size_t k_count() const { return static_cast<std::size_t>(table_.measurements()); }
  std::size_t rank() const { return static_cast<std::size_t>(projection_.rank()); }

  Eigen::VectorXd electrons(std::size_t pixel) const {
    Eigen::VectorXd y(table_.measurements());
    for (int k = 0; k < y.size(); ++k)
      y[k] = scale_.electrons(raw_[pixel * k_count() + static_cast<std::size_t>(k)], k);
    return y;
  }
  Eigen::VectorXd plane_of(const Eigen::VectorXd& y) const {
    const Eigen::VectorXd q = projection_.basis.transpose() * y;
    return q.norm() <= nothing_left * y.lpNorm<1>() ? Eigen::VectorXd::Zero(q.size()).eval() : q;
  }
  Eigen::VectorXd direction(std::int32_t n) const {
    Eigen::VectorXd u(projection_.rank());
    for (int j = 0; j < u.size(); ++j) u[j] = directions_.direction(n, j);
    return u;
  }
  std::int32_t best_bin(const Eigen::VectorXd& q, std::int32_t begin, std::int32_t end) const {
    std::int32_t best = begin;
    double score = -std::numeric_limits<double>::infinity();
    for (std::int32_t n = begin; n < end; ++n) {
      const std::int32_t bin = n % table_.samples();
      if (projection_.curve.row(bin).isZero(0.0)) continue;
      if (direction(bin).dot(q) > score) best = bin, score = direction(bin).dot(q);
    }
    return best;
  }

  void match(std::size_t i) {
    const Eigen::VectorXd y = electrons(i);
    const Eigen::VectorXd q = plane_of(y);
    const std::size_t first = i / tile_size * tile_size, lane = i - first;
    for (std::size_t j = 0; j < rank(); ++j)
      plane_[first * rank() + j * tile_size + lane] = static_cast<float>(q[static_cast<int>(j)]);
    for (std::size_t k = 0; k < k_count(); ++k)
      electrons_[first * k_count() + k * tile_size + lane] =
          static_cast<float>(y[static_cast<int>(k)]);
    const float* raw = &raw_[i * k_count()];
    saturated_[i] = table_.saturation_level && std::any_of(raw, raw + k_count(), [&](float value) {
                      return value >= *table_.saturation_level;
                    });
    bin_[i] = rival_[i] = -1;
    if (!y.allFinite()) return;
    bin_[i] = best_bin(q, 0, table_.samples());
    const Lobe lobe = directions_.main_lobe(bin_[i]);
    if (lobe.end - lobe.begin < table_.samples())
      rival_[i] = best_bin(q, lobe.end, lobe.begin + table_.samples());
  }

  DecodingTable table_;
  DecodeOptions options_;
  AmbientProjection projection_;
  DirectionTable directions_;
  PixelModel model_;
  OutputKernel kernel_;
  RawScale scale_;
  std::vector<float> raw_;
  std::size_t pixels_;
  std::vector<float> plane_, electrons_;
  std::vector<std::int32_t> bin_, rival_;
  std::vector<std::uint8_t> saturated_;
};

/// Like depth_bin of the definition, on the circle, in bins.
double off_bins(float depth_m, double depth_bin, const DecodingTable& table) {
  return std::abs(circular_difference(depth_m / table.bin_m(), depth_bin, table.samples()));
}

void expect_near(const std::vector<float>& values, const std::vector<float>& expected, double share,
                 double amount, const char* plane) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_EQ(std::isfinite(values[i]), std::isfinite(expected[i])) << plane << " of pixel " << i;
    if (!std::isfinite(expected[i])) continue;
    ASSERT_NEAR(values[i], expected[i], share * std::abs(expected[i]) + amount)
        << plane << " of pixel " << i;
  }
}

/// Noise is that of the middle of a quarter of a chord, and differs much within it only where a
/// bright pixel's shot noise vanishes.
void expect_similar(const std::vector<float>& deviations, const std::vector<float>& expected) {
  expect_near(deviations, expected, 1.0, 0.0, "deviation");
  double sum = 0.0;
  int finite = 0, others = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!std::isfinite(expected[i])) continue;
    const double share = std::abs(deviations[i] / expected[i] - 1.0);
    sum += share;
    ++finite;
    others += share > 0.1;
  }
  EXPECT_LE(sum, 0.01 * finite);
  EXPECT_LE(others, 0.02 * finite);
}

void expect_agreement(const DecodingTable& table, const std::vector<float>& raw) {
  const Matched matched(table, raw);
  const Outputs expected = matched.expected();
  const double float_error_bin = 1e-4 + 1.2e-7 * table.samples();
  for_each_target([&] {
    const Outputs outputs = matched.outputs();
    int other_status = 0;
    for (std::size_t i = 0; i < matched.pixels(); ++i) {
      other_status += outputs.status[i] != expected.status[i];
      ASSERT_EQ(std::isnan(outputs.depth_m[i]), std::isnan(expected.depth_m[i])) << i;
      if (std::isnan(expected.depth_m[i])) continue;
      const double depth_bin = matched.decoding_of(i).depth_bin;
      ASSERT_LE(off_bins(outputs.depth_m[i], depth_bin, table), float_error_bin) << i;
      ASSERT_GE(outputs.depth_m[i], 0.0f);
      ASSERT_LT(outputs.depth_m[i], static_cast<float>(table.range_m));
      const double to_edge = std::abs(depth_bin - std::floor(depth_bin) - 0.5);
      if (to_edge <= float_error_bin) continue;
      ASSERT_EQ(outputs.bin[i], expected.bin[i]) << i;
    }
    // Noise at the best bin moves the thresholds a little.
    EXPECT_LE(other_status, 5 + static_cast<int>(matched.pixels()) / 500);
    const double brightest =
        *std::max_element(raw.begin(), raw.end()) / table.exposure_s.minCoeff();
    expect_near(outputs.signal, expected.signal, 2e-6, 1e-6 * brightest, "signal");
    expect_near(outputs.ambient, expected.ambient, 2e-6, 1e-6 * brightest, "ambient");
    expect_near(outputs.confidence, expected.confidence, 0.0, 5e-3, "confidence");
    expect_similar(outputs.deviation_m, expected.deviation_m);
  });
}

std::vector<float> pixels_at_all_light_levels(const DecodingTable& table, int each) {
  std::vector<float> raw;
  std::uint64_t seed = 1;
  for (const auto& [signal, ambient] :
       {OperatingPoint{1e3, 1e5}, OperatingPoint{3e3, 1e3}, OperatingPoint{1e4, 1e4},
        OperatingPoint{1e5, 1e2}, OperatingPoint{1e7, 1e5}}) {
    const std::vector<float> more = noisy_pixels(table, signal, ambient, each, seed++);
    raw.insert(raw.end(), more.begin(), more.end());
  }
  return raw;
}

struct Case {
  const char* code;
  const char* camera;
  int taps = 1;
  Readout readout = Readout::separate;
};

class OutputsOfCode : public testing::TestWithParam<Case> {};

TEST_P(OutputsOfCode, AgreeWithDoublePrecision) {
  const Case& c = GetParam();
  const DecodeSetup setup(c.code, camera_with(c.camera, c.taps, c.readout));
  const DecodingTable& table = setup.decoder.table();
  expect_agreement(table, pixels_at_all_light_levels(table, 700));
}

INSTANTIATE_TEST_SUITE_P(
    Codes, OutputsOfCode,
    testing::Values(Case{"hamiltonian-k3", "paper-30x"}, Case{"hamiltonian-k4", "paper-10f0"},
                    Case{"hamiltonian-k5", "paper-30x"}, Case{"sinusoid-k4", "paper-5f0"},
                    Case{"gray-k4", "paper-30x"}, Case{"multifrequency-k5", "paper-10f0"},
                    Case{"hamiltonian-k6", "paper-30x"}, Case{"sinusoid-k8", "paper-30x"},
                    Case{"hamiltonian-k4", "paper-10f0", 2},
                    Case{"hamiltonian-k5", "paper-10f0", 2, Readout::difference}));

TEST(OutputKernel, AgreesWithDoublePrecisionWithUnequalExposures) {
  Camera camera = camera_with("paper-10f0");
  camera.exposure_s.each_s = {0.02, 0.05, 0.1, 0.13};
  const DecodeSetup setup("hamiltonian-k4", camera);
  const DecodingTable& table = setup.decoder.table();
  expect_agreement(table, pixels_at_all_light_levels(table, 300));
}

TEST(OutputKernel, FindsDepthsBetweenBinsInAnyLight) {
  for (const int samples : {240, 1020, 10020}) {
    Camera camera = camera_with("paper-30x");
    camera.samples = samples;
    const DecodeSetup setup("hamiltonian-k3", camera);
    const DecodingTable& table = setup.decoder.table();
    std::vector<float> raw;
    for (int i = 0; i < 300; ++i)
      setup.append_expected(raw, 1e4, samples * i / 300.0 + 0.37 * i / 300.0, 1e6);
    const Matched matched(table, raw);
    const Outputs outputs = matched.outputs();
    for (std::size_t i = 0; i < matched.pixels(); ++i)
      ASSERT_LE(off_bins(outputs.depth_m[i], matched.decoding_of(i).depth_bin, table),
                samples > 10000 ? 0.1 : 0.02)
          << samples << " samples, pixel " << i;
  }
}

TEST(OutputKernel, AddsFractionsToHighBins) {
  // A circle: the angle is the depth.
  const int samples = 10000;
  Eigen::MatrixXd correlation(samples, 3);
  for (int n = 0; n < samples; ++n)
    for (int k = 0; k < 3; ++k)
      correlation(n, k) = std::cos(2 * std::numbers::pi * (n / double(samples) - k / 3.0));
  const DecodingTable table = make_decoding_table(correlation, 9.99308193333);
  std::vector<float> raw;
  for (int i = 0; i < 512; ++i)
    for (int k = 0; k < 3; ++k)
      raw.push_back(
          static_cast<float>(1000.0 * std::cos(2 * std::numbers::pi * (i / 512.1 - k / 3.0))));
  const Matched matched(table, raw);
  const Outputs outputs = matched.outputs();
  for (std::size_t i = 0; i < matched.pixels(); ++i)
    ASSERT_LE(off_bins(outputs.depth_m[i], matched.decoding_of(i).depth_bin, table), 1.5e-3) << i;
}

TEST(OutputKernel, WrapsDepthsAtTheEndOfTheRange) {
  const DecodeSetup setup("sinusoid-k4", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  std::vector<float> raw;
  for (int i = -100; i <= 100; ++i)
    setup.append_expected(raw, 1e5, i < 0 ? table.samples() + i * 0.01 : i * 0.01, 1e2);
  setup.append_expected(raw, 1e5, table.samples() - 1e-7, 1e2);
  expect_agreement(table, raw);
}

TEST(OutputKernel, NeedsNoContrastEverywhere) {
  // Bins 3 and 4 see all measurements alike.
  Eigen::MatrixXd correlation(12, 3);
  for (int n = 0; n < 12; ++n) correlation.row(n) << n % 5, n, 12 - n;
  correlation.row(3).setConstant(5.0);
  correlation.row(4).setConstant(7.0);
  DecodingTable table = make_decoding_table(correlation, 10.0);
  table.constant_variance_e2.setOnes();
  std::vector<float> raw;
  RandomStream random(5, 0);
  for (int i = 0; i < 3 * 400; ++i) raw.push_back(static_cast<float>(10.0 * random.normal()));
  const Matched matched(table, raw);
  const Outputs outputs = matched.outputs(), expected = matched.expected();
  for (std::size_t i = 0; i < matched.pixels(); ++i) {
    ASSERT_EQ(std::isnan(outputs.depth_m[i]), std::isnan(expected.depth_m[i])) << i;
    if (std::isnan(expected.depth_m[i])) continue;
    ASSERT_LE(off_bins(outputs.depth_m[i], matched.decoding_of(i).depth_bin, table), 1e-4) << i;
  }
}

TEST(OutputKernel, NamesPixelsWithoutDepth) {
  Camera camera = camera_with("paper-10f0");
  camera.sensor.full_well_e = 5000.0;
  const DecodeSetup setup("hamiltonian-k4", camera);
  const DecodingTable& table = setup.decoder.table();
  std::vector<float> raw = noisy_pixels(table, 1e4, 1e3, 40, 3);
  const auto set = [&raw](std::size_t pixel, const std::array<float, 4>& values) {
    std::copy(values.begin(), values.end(), raw.begin() + 4 * static_cast<std::ptrdiff_t>(pixel));
  };
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  set(3, {1.0f, nan, 2.0f, 3.0f});
  set(17, {infinity, 1.0f, 2.0f, 3.0f});
  set(18, {700.0f, 700.0f, 700.0f, 700.0f});
  set(19, {5000.0f, 5000.0f, 5000.0f, 5000.0f});
  set(20, {5000.0f, 100.0f, 200.0f, 300.0f});
  const Matched matched(table, raw);
  for_each_target([&] {
    const Outputs outputs = matched.outputs();
    EXPECT_EQ(outputs.status, matched.expected().status);
    EXPECT_EQ(outputs.bin, matched.expected().bin);
    EXPECT_EQ(outputs.status[3], PixelStatus::invalid);
    EXPECT_EQ(outputs.status[17], PixelStatus::invalid);
    EXPECT_EQ(outputs.status[18], PixelStatus::no_return);
    EXPECT_EQ(outputs.status[19], PixelStatus::saturated);
    EXPECT_EQ(outputs.status[20], PixelStatus::saturated);
    EXPECT_EQ(outputs.status[21], PixelStatus::ok);
    for (const std::size_t pixel : {3, 17, 18, 19})
      for (const auto* plane : {&outputs.depth_m, &outputs.signal, &outputs.ambient,
                                &outputs.confidence, &outputs.deviation_m})
        EXPECT_TRUE(std::isnan((*plane)[pixel])) << pixel;
    EXPECT_TRUE(std::isfinite(outputs.depth_m[20]));
  });
}

TEST(OutputKernel, HasAllStatuses) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-30x"));
  const DecodingTable& table = setup.decoder.table();
  const Outputs outputs = Matched(table, pixels_at_all_light_levels(table, 700)).outputs();
  for (const auto status : {PixelStatus::ok, PixelStatus::low_signal, PixelStatus::ambiguous})
    EXPECT_GT(std::count(outputs.status.begin(), outputs.status.end(), status), 20);
}

TEST(OutputKernel, WritesNothingPastATile) {
  const DecodeSetup setup("hamiltonian-k3", camera_with("paper-30x"));
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e4, 1e4, pixels_per_tile, 4);
  const Outputs whole = Matched(setup.decoder.table(), raw).outputs();
  for (const std::size_t pixels : {0, 1, 3, 15, 16, 17, 63, 64, 65, 200, 255}) {
    const Matched part(setup.decoder.table(),
                       {raw.begin(), raw.begin() + 3 * static_cast<std::ptrdiff_t>(pixels)});
    for_each_target([&] {
      Outputs outputs(tile_size), expected(tile_size);
      part.write(outputs.view());
      std::copy_n(whole.bin.begin(), pixels, expected.bin.begin());
      std::copy_n(whole.depth_m.begin(), pixels, expected.depth_m.begin());
      std::copy_n(whole.signal.begin(), pixels, expected.signal.begin());
      std::copy_n(whole.ambient.begin(), pixels, expected.ambient.begin());
      std::copy_n(whole.confidence.begin(), pixels, expected.confidence.begin());
      std::copy_n(whole.deviation_m.begin(), pixels, expected.deviation_m.begin());
      std::copy_n(whole.status.begin(), pixels, expected.status.begin());
      expect_same(outputs, expected);
    });
  }
}

TEST(OutputKernel, NeedsOnlyWhatThePlanesTake) {
  const DecodeSetup setup("hamiltonian-k3", camera_with("paper-30x"));
  const Matched matched(setup.decoder.table(),
                        noisy_pixels(setup.decoder.table(), 1e4, 1e4, 100, 6));
  std::vector<float> depth_m(100);
  const DecodedView planes{.depth_m = depth_m.data()};
  EXPECT_FALSE(matched.kernel().needs_electrons(planes));
  EXPECT_FALSE(matched.kernel().needs_rivals(planes));
  EXPECT_FALSE(matched.kernel().needs_saturation(planes));
  MatchedTile tile = matched.tile(0);
  tile.electrons = nullptr;
  tile.rival = nullptr;
  tile.saturated = nullptr;
  matched.kernel().write(tile, planes);
  EXPECT_TRUE(same(depth_m, matched.outputs().depth_m));
}

Outputs some_of(const Matched& matched, unsigned planes) {
  Outputs result(matched.pixels());
  DecodedView view = result.view();
  if (!(planes & 1u)) view.bin = nullptr;
  if (!(planes & 2u)) view.depth_m = nullptr;
  if (!(planes & 4u)) view.signal_e_per_s = nullptr;
  if (!(planes & 8u)) view.ambient_e_per_s = nullptr;
  if (!(planes & 16u)) view.confidence = nullptr;
  if (!(planes & 32u)) view.predicted_standard_deviation_m = nullptr;
  if (!(planes & 64u)) view.status = nullptr;
  matched.write(view);
  return result;
}

TEST(OutputKernel, APlaneDoesNotDependOnWhichOthersAreWanted) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  const Matched matched(setup.decoder.table(),
                        pixels_at_all_light_levels(setup.decoder.table(), 67));
  const Outputs all = matched.outputs();
  const Outputs none(matched.pixels());
  for (unsigned planes = 0; planes < 128; ++planes) {
    const Outputs some = some_of(matched, planes);
    SCOPED_TRACE(planes);
    EXPECT_EQ(some.bin, planes & 1u ? all.bin : none.bin);
    EXPECT_TRUE(same(some.depth_m, planes & 2u ? all.depth_m : none.depth_m));
    EXPECT_TRUE(same(some.signal, planes & 4u ? all.signal : none.signal));
    EXPECT_TRUE(same(some.ambient, planes & 8u ? all.ambient : none.ambient));
    EXPECT_TRUE(same(some.confidence, planes & 16u ? all.confidence : none.confidence));
    EXPECT_TRUE(same(some.deviation_m, planes & 32u ? all.deviation_m : none.deviation_m));
    EXPECT_EQ(some.status, planes & 64u ? all.status : none.status);
  }
}

TEST(OutputKernel, SaysTheSameOnEveryInstructionSet) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0", 2));
  const Matched matched(setup.decoder.table(),
                        pixels_at_all_light_levels(setup.decoder.table(), 300));
  const Outputs expected = matched.outputs();
  for_each_target([&] { expect_same(matched.outputs(), expected); });
}

}  // namespace
}  // namespace tofsmith
