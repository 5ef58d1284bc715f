// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/depth_limits.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "decode/output/pixel_model.hpp"
#include "decode/unwrap/phase_unwrapper.hpp"
#include "decode_setup.hpp"
#include "reference_decoder.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/frame_pipeline.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Differences of two taps at 80 and 100 MHz: 7.5 m, with wraps that are 1.5 and 1.9 m apart.
Camera two_frequency_camera() {
  Camera camera = camera_with("paper-30x", 2, Readout::difference);
  camera.fundamental_frequency_hz = 20e6;
  return camera;
}
constexpr const char* two_frequencies = "multifrequency-4x4-5x4";
DecodingTable two_frequency_table() {
  return decoding_table_of(two_frequencies, two_frequency_camera());
}

/// Pixels of one row, each at its depth.
RawFrames pixels_at(const DecodingTable& table, const std::vector<double>& depths_m, double signal,
                    double ambient) {
  RandomStream random(1, 0);
  std::vector<float> raw;
  for (const double depth_m : depths_m)
    append_noisy_pixel(table, signal, ambient, wrap(depth_m, table.range_m) / table.bin_m(), random,
                       raw);
  return frame_of(raw, table.measurements());
}

std::vector<double> evenly(double from_m, double to_m, int count) {
  std::vector<double> depths_m;
  for (int i = 0; i < count; ++i) depths_m.push_back(from_m + (to_m - from_m) * (i + 0.5) / count);
  return depths_m;
}

DepthImage decoded(DecodeMethod method, const DecodingTable& table, const RawFrames& raw,
                   const PlaneCorrections& corrections) {
  const std::unique_ptr<FrameBackend> backend = cpu_backend(make_decoder(method, table));
  const std::unique_ptr<FramePipeline> pipeline = backend->prepare({}, raw.height, raw.width);
  pipeline->submit(view_of_frame(raw, 0));
  DepthImage image(usual_planes(), raw.height, raw.width);
  decode_frame(*pipeline, corrections, 0, raw.height, DecodedView::of(image));
  return image;
}
DepthImage decoded(DecodeMethod method, const DecodingTable& table, const RawFrames& raw,
                   std::optional<DepthLimits> limits) {
  return decoded(method, table, raw, PlaneCorrections{.limits = limits});
}

/// Pixels decoded with the same part of the range for all.
DepthImage decoded_within(const DepthDecoder& decoder, const RawFrames& raw,
                          const RangePart& part) {
  const std::vector<RangePart> parts(static_cast<std::size_t>(raw.width), part);
  DepthImage image(usual_planes(), 1, raw.width);
  decoder.decode_within(view_of_frame(raw, 0), parts.data(), DecodedView::of(image));
  return image;
}

int count_of(const DepthImage& image, PixelStatus status) {
  return static_cast<int>(std::ranges::count(image.status.pixels, status));
}

/// Methods that decode any pixel of two frequencies.
constexpr std::array methods = {DecodeMethod::zncc, DecodeMethod::ml, DecodeMethod::unwrap};

TEST(DepthLimits, CorrelationIsSearchedAsByBruteForce) {
  const Camera camera = two_frequency_camera();
  const ForwardModel code(build_family(two_frequencies, camera), camera);
  // The rows are so close that the best of them is the best point.
  const DecodingTable table = make_decoding_table(code.correlation_table(3000), 7.5);
  const int rows = table.samples(), count = table.measurements();
  const PixelModel model(table, AmbientProjection(table));
  const ReferenceDecoder reference(table);
  const std::vector<float> raw = noisy_pixels(table, 300.0, 3e3, 400, 1);
  int compared = 0;
  for (const RangePart part : {RangePart{0.2, 0.3}, RangePart{0.9, 0.25}, RangePart{0.5, 0.05}})
    for (std::size_t first = 0; first < raw.size(); first += static_cast<std::size_t>(count)) {
      const Eigen::VectorXd q = reference.difference(&raw[first]);
      const auto is_inside = [&](double row) { return part.contains(row / rows); };
      std::optional<double> best;
      bool is_at_end = false;  // a peak between the row at the end and the end
      for (int n = 0; n < rows; ++n) {
        const double here = reference.score(q, n);
        if (here < reference.score(q, (n + 1) % rows) ||
            here < reference.score(q, (n + rows - 1) % rows))
          continue;
        is_at_end |= is_inside(n - 1) != is_inside(n + 1);
        if (is_inside(n)) best = std::max(best.value_or(here), here);
      }
      if (is_at_end) continue;
      const Eigen::VectorXd electrons =
          Eigen::Map<const Eigen::VectorXf>(&raw[first], count).cast<double>();
      std::array<double, max_measurements> plane;
      model.project(electrons.data(), plane.data());
      const std::optional<Position> found = model.best_within(plane.data(), part);
      ASSERT_EQ(found.has_value(), best.has_value());
      ++compared;
      if (!found) continue;
      EXPECT_TRUE(is_inside(found->in_rows(rows)));
      const int row = static_cast<int>(std::lround(found->in_rows(rows))) % rows;
      EXPECT_GE(reference.score(q, row), *best - 1e-4 * q.norm());
    }
  EXPECT_GT(compared, 1100);
}

TEST(DepthLimits, WrapsAreSearchedAsByBruteForce) {
  const std::array<double, 2> frequency = {4.0, 5.0}, weight = {0.4, 0.6};
  const PhaseUnwrapper unwrapper({4, 5}, {0.4, 0.6});
  const RangePart part{0.7, 0.45};
  RandomStream random(1, 0);
  for (int i = 0; i < 200; ++i) {
    const std::array<double, 2> phase = {random.uniform() - 0.5, random.uniform() - 0.5};
    double least = std::numeric_limits<double>::infinity(), best = 0.0;
    for (int first = 0; first < 4; ++first)
      for (int second = -1; second < 6; ++second) {
        const double a = (phase[0] + first) / frequency[0], b = (phase[1] + second) / frequency[1];
        const double depth = weight[0] * a + weight[1] * b;
        const double distance =
            weight[0] * std::pow(a - depth, 2) + weight[1] * std::pow(b - depth, 2);
        if (!part.contains(depth) || distance >= least) continue;
        least = distance;
        best = depth;
      }
    const Wraps found = unwrapper.nearest(phase.data(), &part);
    EXPECT_NEAR(found.distance, least, 1e-12) << i;
    EXPECT_NEAR(circular_difference(found.depth, best, 1.0), 0.0, 1e-12) << i;
  }
}

TEST(DepthLimits, BestDepthAnywhereIsTheBestOfItsPartOfTheRange) {
  const DecodingTable table = two_frequency_table();
  const RawFrames raw = frame_of(noisy_pixels(table, 500.0, 3e3, 400, 2), table.measurements());
  for (const DecodeMethod method : methods) {
    const auto decoder = make_decoder(method, table);
    const DepthImage anywhere = decoded_within(*decoder, raw, {});
    for (const RangePart part :
         {RangePart{0.15, 0.35}, RangePart{0.5, 0.25}, RangePart{0.75, 0.4}}) {
      const DepthImage within = decoded_within(*decoder, raw, part);
      for (int i = 0; i < raw.width; ++i) {
        const float depth_m = within.depth_m.pixels[i];
        // Maximum likelihood follows its chosen peak by up to three rows.
        const double rows = 3.0 / table.samples();
        const RangePart nearly(part.begin - rows, part.length + 2.0 * rows);
        EXPECT_TRUE(std::isnan(depth_m) || nearly.contains(depth_m / table.range_m))
            << name_of(method) << i;
        if (!part.contains(anywhere.depth_m.pixels[i] / table.range_m)) continue;
        EXPECT_EQ(depth_m, anywhere.depth_m.pixels[i]) << name_of(method) << i;
        EXPECT_GE(within.confidence.pixels[i], anywhere.confidence.pixels[i] - 1e-3f)
            << name_of(method) << i;
      }
    }
  }
}

TEST(DepthLimits, WholeRangeChangesNoDepth) {
  const DecodingTable table = two_frequency_table();
  const RawFrames raw = frame_of(noisy_pixels(table, 1e4, 3e3, 300, 3), table.measurements());
  for (const DecodeMethod method : methods) {
    const auto decoder = make_decoder(method, table);
    DepthImage plain(usual_planes(), 1, raw.width);
    decoder->decode(view_of_frame(raw, 0), DecodedView::of(plain));
    const DepthImage within = decoded_within(*decoder, raw, {0.25, 1.0});
    for (int i = 0; i < raw.width; ++i) {
      EXPECT_NEAR(plain.depth_m.pixels[i], within.depth_m.pixels[i], 1e-5) << name_of(method);
      EXPECT_EQ(plain.status.pixels[i], within.status.pixels[i]) << name_of(method);
      EXPECT_NEAR(plain.confidence.pixels[i], within.confidence.pixels[i], 2e-3) << name_of(method);
    }
  }
}

/// Share of pixels further than half a wrap from their depths; a pixel without depth is none.
double share_of_wrong_wraps(const DepthImage& image, const std::vector<double>& depths_m,
                            double range_m) {
  double wrong = 0.0;
  for (std::size_t i = 0; i < depths_m.size(); ++i)
    wrong += std::abs(circular_difference(image.depth_m.pixels[i], depths_m[i], range_m)) > 0.5;
  return wrong / static_cast<double>(depths_m.size());
}

TEST(DepthLimits, WrapsOutsideAreNoLongerCandidates) {
  const DecodingTable table = two_frequency_table();
  const std::vector<double> depths_m = evenly(1.1, 2.4, 2000);
  const RawFrames raw = pixels_at(table, depths_m, 4000.0, 3e3);
  for (const DecodeMethod method : methods) {
    const DepthImage plain = decoded(method, table, raw, std::nullopt);
    const DepthImage limited = decoded(method, table, raw, DepthLimits{1.0, 2.5});
    EXPECT_GT(share_of_wrong_wraps(plain, depths_m, table.range_m), 0.1) << name_of(method);
    EXPECT_LT(share_of_wrong_wraps(limited, depths_m, table.range_m), 0.01) << name_of(method);
    EXPECT_GT(count_of(limited, PixelStatus::ok), 1.2 * count_of(plain, PixelStatus::ok))
        << name_of(method);
  }
}

TEST(DepthLimits, BrightPixelsOutsideAreTooNearOrTooFar) {
  const DecodingTable table = two_frequency_table();
  const RawFrames raw = pixels_at(table, {0.5, 2.0, 3.5, 7.0}, 1e6, 1e4);
  for (const DecodeMethod method : methods) {
    const DepthImage image = decoded(method, table, raw, DepthLimits{1.0, 2.5});
    EXPECT_THAT(image.status.pixels,
                testing::ElementsAre(PixelStatus::too_near, PixelStatus::ok, PixelStatus::too_far,
                                     PixelStatus::too_far))
        << name_of(method);
    EXPECT_NEAR(image.depth_m.pixels[1], 2.0f, 5e-3f);
    for (const int i : {0, 2, 3}) {
      EXPECT_TRUE(std::isnan(image.depth_m.pixels[i]));
      EXPECT_TRUE(std::isnan(image.confidence.pixels[i]));
      EXPECT_TRUE(std::isnan(image.signal_e_per_s.pixels[i]));
    }
  }
}

TEST(DepthLimits, FewPixelsOutsideAreOkInAnyLight) {
  const DecodingTable table = two_frequency_table();
  const std::vector<double> depths_m = evenly(2.7, 7.3, 2000);
  for (const double signal : {2e3, 4e3, 6e3, 1e4, 1e5}) {
    const RawFrames raw = pixels_at(table, depths_m, signal, 3e3);
    const DepthImage image = decoded(DecodeMethod::zncc, table, raw, DepthLimits{1.0, 2.5});
    EXPECT_LT(count_of(image, PixelStatus::ok), 400) << signal;
    EXPECT_TRUE(signal < 1e4 || count_of(image, PixelStatus::too_far) > 1900) << signal;
  }
}

TEST(DepthLimits, DepthNeverIsALimit) {
  // A sinusoid has one lobe: a pixel just outside the limits has no other candidate.
  const DecodingTable table = decoding_table_of("sinusoid-k4", camera_with("paper-10f0"));
  const std::vector<double> depths_m = evenly(2.5, 3.5, 1000);
  const RawFrames raw = pixels_at(table, depths_m, 1e5, 1e3);
  for (const DecodeMethod method : methods) {
    const DepthImage image = decoded(method, table, raw, DepthLimits{1.0, 3.0});
    for (std::size_t i = 0; i < depths_m.size(); ++i) {
      if (std::isnan(image.depth_m.pixels[i])) continue;
      EXPECT_LT(image.depth_m.pixels[i], 3.0f) << name_of(method);
      EXPECT_NEAR(image.depth_m.pixels[i], depths_m[i], 0.3) << name_of(method);
    }
    EXPECT_GT(count_of(image, PixelStatus::too_far), 400) << name_of(method);
    EXPECT_EQ(count_of(image, PixelStatus::too_near), 0) << name_of(method);
  }
}

TEST(DepthLimits, DarkPixelsAreNotTooFar) {
  const DecodingTable table = two_frequency_table();
  const RawFrames raw = pixels_at(table, std::vector<double>(2000, 1.0), 0.0, 3e3);
  for (const DecodeMethod method : methods) {
    const DepthImage image = decoded(method, table, raw, DepthLimits{1.0, 2.5});
    EXPECT_LT(count_of(image, PixelStatus::too_near) + count_of(image, PixelStatus::too_far) +
                  count_of(image, PixelStatus::ok),
              20)
        << name_of(method);
  }
}

TEST(DepthLimits, MultipathMethodsKeepToThem) {
  const Camera camera = camera_with("paper-10f0", 2);
  const ForwardModel model(build_family("hamiltonian-k5", camera), camera);
  const DecodingTable table = make_decoding_table(model, camera);
  RawFrames raw{.frames = 1, .height = 1, .width = 60, .measurements = 10, .values = {}};
  for (int i = 0; i < raw.width; ++i) {
    const double bin = (2.0 + 6.0 * i / raw.width) / camera.bin_m();
    const std::array returns = {Return{1e6, bin}, Return{3e5, bin + 1.0 / camera.bin_m()}};
    for (const double e : model.expected_electrons(returns, 1e4))
      raw.values.push_back(static_cast<float>(e));
  }
  for (const DecodeMethod method : {DecodeMethod::two_return, DecodeMethod::tail}) {
    const DepthLimits limits{4.0, 6.0};
    const DepthImage plain = decoded(method, table, raw, std::nullopt);
    const DepthImage image = decoded(method, table, raw, limits);
    for (int i = 0; i < raw.width; ++i) {
      const float depth_m = plain.depth_m.pixels[i];
      if (limits.contains(depth_m))
        EXPECT_NEAR(image.depth_m.pixels[i], depth_m, 1e-3) << name_of(method);
      else
        EXPECT_FALSE(image.status.pixels[i] == PixelStatus::ok) << name_of(method) << i;
    }
  }
}

TEST(DepthLimits, AndOtherCorrectionsRequireTheirPlanes) {
  using enum DecodedPlane;
  DecodingTable table = two_frequency_table();
  PlaneCorrections corrections;
  EXPECT_THAT(planes_for(corrections, table), testing::IsEmpty());
  corrections.limits = DepthLimits{1.0, 2.5};
  EXPECT_THAT(planes_for(corrections, table), testing::ElementsAre(depth, confidence, status));
  corrections.mixed = MixedPixels::label;
  EXPECT_THAT(planes_for(corrections, table),
              testing::ElementsAre(depth, confidence, deviation, status));
  table.correction = DepthCorrection{.height = 1, .width = 1};
  table.correction->known.signal_m = Eigen::VectorXd::Ones(1);
  EXPECT_THAT(planes_for({}, table), testing::ElementsAre(signal));
}

TEST(DepthLimits, HoldForDepthsAfterTheOffsetMap) {
  Camera camera = camera_with("paper-10f0");
  camera.fundamental_frequency_hz = 48e6;
  const DecodingTable table = decoding_table_of("sinusoid-k4", camera);
  const RawFrames raw = pixels_at(table, {0.02, 0.12, 2.97, 3.03, 3.1}, 1e7, 1e3);
  PlaneCorrections corrections{.maps = {.delay_offset_m = Image<float>(1, 5, 0.05f), .gain = {}}};
  const DepthImage plain = decoded(DecodeMethod::zncc, table, raw, corrections);
  EXPECT_NEAR(plain.depth_m.pixels[0], 3.093f, 2e-3f);
  corrections.limits = DepthLimits{0.05, 3.0};
  for (const DecodeMethod method : methods) {
    const DepthImage image = decoded(method, table, raw, corrections);
    EXPECT_TRUE(std::isnan(image.depth_m.pixels[0])) << name_of(method);
    EXPECT_EQ(image.status.pixels[0], PixelStatus::too_far);
    EXPECT_NEAR(image.depth_m.pixels[1], 0.07f, 2e-3f);
    EXPECT_NEAR(image.depth_m.pixels[2], 2.92f, 2e-3f);
    EXPECT_NEAR(image.depth_m.pixels[3], 2.98f, 2e-3f);
    EXPECT_EQ(image.status.pixels[4], PixelStatus::too_far);
  }
}

TEST(DepthLimits, OfACameraAreItsWorkingDistanceUnlessOthersAreGiven) {
  Camera camera = two_frequency_camera();
  EXPECT_FALSE(depth_limits(decoding_table_of(two_frequencies, camera), {}, {}));
  camera.operating.working_distance_m = {0.4, 3.0};
  const DecodingTable table = decoding_table_of(two_frequencies, camera);
  const auto limits_of = [&](std::optional<double> min_m, std::optional<double> max_m) {
    const DepthLimits limits = depth_limits(table, min_m, max_m).value();
    return std::pair(limits.min_m, limits.max_m);
  };
  EXPECT_EQ(limits_of({}, {}), std::pair(0.4, 3.0));
  EXPECT_EQ(limits_of(0.0, {}), std::pair(0.0, 3.0));
  EXPECT_EQ(limits_of({}, 5.0), std::pair(0.4, 5.0));
  EXPECT_EQ(limits_of(1.0, 7.0), std::pair(1.0, 7.0));
}

TEST(DepthLimits, ImpossibleLimitsAreRejectedByName) {
  DecodingTable table = two_frequency_table();
  const auto message_of = [&](std::optional<double> min_m, std::optional<double> max_m) {
    try {
      depth_limits(table, min_m, max_m);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(message_of(-1.0, 2.0), HasSubstr("min_depth_m = -1; must be finite and >= 0"));
  EXPECT_THAT(message_of(std::nan(""), 2.0), HasSubstr("min_depth_m = nan"));
  EXPECT_THAT(message_of({}, std::nan("")), HasSubstr("max_depth_m = nan"));
  EXPECT_THAT(message_of(0.5, 8.0),
              HasSubstr("max_depth_m = 8; must be > 0 and at most the unambiguous range"));
  EXPECT_THAT(message_of(2.0, 2.0), HasSubstr("min_depth_m = 2; must be below the largest depth"));
  EXPECT_THAT(message_of(7.6, {}), HasSubstr("min_depth_m = 7.6; must be below"));
  table.working_distance_m = {1.0, 9.0};
  EXPECT_THAT(message_of({}, {}), HasSubstr("operating.working_distance_m = [1, 9]"));
  EXPECT_EQ(message_of(0.5, 7.0), "accepted");
  table.working_distance_m = {1.0, 5.0};
  EXPECT_THAT(message_of({}, 0.8), HasSubstr("max_depth_m = 0.8; must be above"));
}

}  // namespace
}  // namespace tofsmith
