// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/reference_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "calibrate/harmonic_fit.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

namespace {

constexpr std::size_t min_compared = 100;
constexpr double max_compared = 2.5e5;

/// |mean of exp(i turn (depth -+ reference) / range)|: 1 if they agree up to an offset.
template <typename Reference>
double coherence(const std::vector<ReferenceSample>& samples, double range_m, double sign,
                 const Reference& reference_m) {
  std::complex<double> sum = 0.0;
  double count = 0.0;
  for (const ReferenceSample& s : samples) {
    const double other_m = reference_m(s);
    if (std::isnan(other_m)) continue;
    sum += std::polar(1.0, turn * (s.depth_m - sign * other_m) / range_m);
    count += 1.0;
  }
  return count < 0.5 * static_cast<double>(samples.size()) ? 0.0 : std::abs(sum) / count;
}

/// Median deviation of depth -+ reference from its typical offset [m].
template <typename Reference>
double scatter_of(const std::vector<ReferenceSample>& samples, double range_m, double sign,
                  const Reference& reference_m) {
  std::complex<double> sum = 0.0;
  std::vector<double> difference_m;
  for (const ReferenceSample& s : samples) {
    const double here_m = s.depth_m - sign * reference_m(s);
    if (std::isnan(here_m)) continue;
    difference_m.push_back(here_m);
    sum += std::polar(1.0, turn * here_m / range_m);
  }
  if (difference_m.size() < samples.size() / 2) return INFINITY;
  const double usual_m = std::arg(sum) / turn * range_m;
  for (double& d : difference_m) d = std::abs(wrapped_difference_m(d - usual_m, range_m));
  std::ranges::nth_element(difference_m, difference_m.begin() + difference_m.size() / 2);
  return difference_m[difference_m.size() / 2];
}

}  // namespace

void require_same_size(const RawFrames& frames, const ReferenceDepth& reference) {
  const auto images = static_cast<int>(reference.depth_m.size());
  require(images == 1 || images == frames.frames, "reference", fmt::format("{} images", images),
          fmt::format("must be one, or one for each of the {} frames", frames.frames));
  for (const Image<float>& image : reference.depth_m)
    require(image.size() == 1 || (image.height == frames.height && image.width == frames.width),
            "reference", fmt::format("{} x {}", image.height, image.width),
            fmt::format("must be {} x {}, like the frames, or one distance", frames.height,
                        frames.width));
}

double reference_at(const ReferenceDepth& reference, int frame, int row, int column) {
  const Image<float>& image =
      reference.depth_m[reference.depth_m.size() == 1 ? 0 : static_cast<std::size_t>(frame)];
  if (image.size() == 1) return static_cast<double>(image.pixels[0]);
  if (row < 0 || column < 0 || row >= image.height || column >= image.width) return NAN;
  const auto depth_m = static_cast<double>(image(row, column));
  return std::isfinite(depth_m) && depth_m > 0.0 ? depth_m : NAN;
}

double wrapped_difference_m(double difference_m, double range_m) {
  return difference_m - range_m * std::floor(difference_m / range_m + 0.5);
}

std::vector<ReferenceSample> decoded_samples(const RawFrames& frames,
                                             const ReferenceDepth& reference,
                                             const DecodingTable& table, const Progress& progress) {
  // Model errors are calibrated here.
  const Decoder decoder(table, {.false_alarm_rate = 0.0});
  const double all = static_cast<double>(frames.pixels_per_frame()) * frames.frames;
  const int stride = std::max(1, static_cast<int>(std::ceil(std::sqrt(all / max_compared))));
  const ProgressParts parts(progress, static_cast<std::size_t>(frames.frames));
  std::vector<ReferenceSample> samples;
  for (int f = 0; f < frames.frames; ++f) {
    const DepthImage image = decoder.decode(frames, f, parts[static_cast<std::size_t>(f)]);
    for (int row = f % stride; row < frames.height; row += stride)
      for (int column = f % stride; column < frames.width; column += stride) {
        const PixelStatus status = image.status(row, column);
        const double reference_m = reference_at(reference, f, row, column);
        const auto deviation_m = static_cast<double>(image.deviation_m(row, column));
        if (!(reference_m > 0.0) || !(deviation_m >= 0.0)) continue;
        if (status != PixelStatus::ok && status != PixelStatus::low_signal) continue;
        samples.push_back({f, row, column, static_cast<double>(image.depth_m(row, column)),
                           reference_m, static_cast<double>(image.signal_e_per_s(row, column)),
                           deviation_m});
      }
  }
  return samples;
}

std::vector<ReferenceSample> reference_samples(const RawFrames& frames,
                                               const ReferenceDepth& reference,
                                               const DecodingTable& table,
                                               const Progress& progress) {
  std::vector<ReferenceSample> samples = decoded_samples(frames, reference, table, progress);
  require(samples.size() >= min_compared, "reference", fmt::format("{} pixels", samples.size()),
          fmt::format("must have depth in at least {} pixels with a decoded depth", min_compared));
  return samples;
}

bool runs_backwards(const std::vector<ReferenceSample>& samples, const ReferenceDepth& reference,
                    int height, int width, double range_m) {
  const auto plain = [](const ReferenceSample& s) { return s.reference_m; };
  const double forwards = coherence(samples, range_m, 1.0, plain);
  const double backwards = coherence(samples, range_m, -1.0, plain);
  const bool reversed = backwards > forwards + 0.05 && 1.0 - backwards < 0.5 * (1.0 - forwards);
  const double found = std::max(forwards, backwards), sign = reversed ? -1.0 : 1.0;

  constexpr double differs = 0.6, far_ranges = 20.0, far_m = 100.0;
  std::vector<double> reference_m;
  for (const ReferenceSample& s : samples) reference_m.push_back(s.reference_m);
  std::ranges::nth_element(reference_m, reference_m.begin() + reference_m.size() / 2);
  const double middle_m = reference_m[reference_m.size() / 2];
  require(middle_m < std::max(far_m, far_ranges * range_m), "reference",
          fmt::format("median {:.4g}", middle_m),
          "must be in metres; this looks like millimetres or centimetres");
  if (found < differs) {
    // Any unit fits a scene with few depths, so it must be better than a constant.
    double best_m =
        0.5 * scatter_of(samples, range_m, 1.0, [](const ReferenceSample&) { return 0.0; });
    std::string best_unit;
    for (const auto& [scale, unit] :
         {std::pair{1e-3, "millimetres"}, std::pair{1e-2, "centimetres"}})
      for (const double direction : {1.0, -1.0}) {
        const double scaled_m =
            scatter_of(samples, range_m, direction,
                       [in_m = scale](const ReferenceSample& s) { return in_m * s.reference_m; });
        if (scaled_m >= best_m) continue;
        best_m = scaled_m;
        best_unit = unit;
      }
    require(best_unit.empty(), "reference", best_unit, "must be in metres");
  }
  const double scatter_m = scatter_of(samples, range_m, sign, plain);
  struct Flip {
    bool rows, columns;
    const char* name;
  };
  for (const Flip& flip :
       {Flip{true, false, "flipped top to bottom"}, Flip{false, true, "mirrored left to right"},
        Flip{true, true, "rotated by 180 degrees"}})
    for (const double direction : {1.0, -1.0}) {
      const double other_m = scatter_of(samples, range_m, direction, [&](const ReferenceSample& s) {
        return reference_at(reference, s.frame, flip.rows ? height - 1 - s.row : s.row,
                            flip.columns ? width - 1 - s.column : s.column);
      });
      require(other_m > 0.3 * scatter_m, "reference", flip.name,
              "must show the same scene as the frames, pixel by pixel");
    }
  require(found >= differs, "reference", fmt::format("agreement {:.2f}", found),
          "must be >= 0.6, apart from an offset; check that the reference shows this scene, in "
          "metres along the ray, and check --code and the order of exposures");
  return sign < 0.0;
}

std::optional<std::string> shift_note(const std::vector<ReferenceSample>& samples,
                                      const ReferenceDepth& reference,
                                      const std::vector<double>& expected_m, double range_m,
                                      double scatter_m) {
  constexpr int reach = 2, side = 2 * reach + 1;
  constexpr std::size_t min_edges = 200;
  std::array<double, side * side> cost{};
  std::size_t edges = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const ReferenceSample& s = samples[i];
    std::array<double, side * side> here{};
    double least_m = INFINITY, most_m = -INFINITY;
    for (int k = 0; k < side * side; ++k) {
      const double at_m =
          reference_at(reference, s.frame, s.row + k / side - reach, s.column + k % side - reach);
      least_m = std::min(least_m, at_m);
      most_m = std::max(most_m, at_m);
      here[static_cast<std::size_t>(k)] =
          std::isnan(at_m) ? NAN
                           : std::min(std::abs(wrapped_difference_m(expected_m[i] - at_m, range_m)),
                                      20.0 * scatter_m);
    }
    if (!(most_m - least_m > 4.0 * scatter_m) ||
        std::ranges::any_of(here, [](double v) { return std::isnan(v); }))
      continue;
    ++edges;
    for (std::size_t k = 0; k < cost.size(); ++k) cost[k] += here[k];
  }
  if (edges < min_edges) return std::nullopt;
  const auto best = static_cast<int>(std::ranges::min_element(cost) - cost.begin());
  constexpr int middle = side * side / 2;
  if (best == middle || cost[static_cast<std::size_t>(best)] > 0.85 * cost[middle])
    return std::nullopt;
  return fmt::format(
      "the reference seems to be shifted: {} rows and {} columns farther on, it fits {:.0f} % "
      "better at edges; shift it back",
      best / side - reach, best % side - reach,
      100.0 * (1.0 - cost[static_cast<std::size_t>(best)] / cost[middle]));
}

ReferenceDepth read_reference_depth(const std::filesystem::path& path) {
  if (known_extension(path, {".npy", ".npz", ".exr", ".pfm", ".png"}) != ".npy")
    return {{read_depth(path)}};
  const NpyArray array = read_npy(path);
  const std::size_t axes = array.axes();
  if (axes < 1 || axes > 3 || array.size() == 0)
    throw IoError(path.string(),
                  fmt::format("found the shape {}; expected (H, W), (F, H, W), or (F,), a distance "
                              "for each frame",
                              describe_shape(array.shape())));
  const std::vector<double> values = array.to_doubles();
  const auto side = [&](std::size_t from_end) {
    return axes == 1 ? 1 : static_cast<int>(array.shape()[axes - from_end]);
  };
  ReferenceDepth reference;
  const std::size_t images = axes == 2 ? 1 : array.shape()[0];
  for (std::size_t i = 0; i < images; ++i) {
    Image<float> image(side(2), side(1));
    for (std::size_t p = 0; p < image.size(); ++p)
      image.pixels[p] = static_cast<float>(values[i * image.size() + p]);
    reference.depth_m.push_back(std::move(image));
  }
  return reference;
}

}  // namespace tofsmith
