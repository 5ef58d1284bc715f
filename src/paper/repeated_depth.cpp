// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/repeated_depth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulate/shared/row_capture.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

namespace {

struct PixelStatistics {
  RunningStatistics depth_m, error_m, outlier;
};

Image<float> reference_of(const SceneImage& scene, const Camera& camera,
                          const RepeatedDepthOptions& options) {
  const Image<float>& given = options.reference_m;
  if (given.empty()) return wrapped_depth_m(scene, camera);
  require(given.height == scene.height() && given.width == scene.width(), "size of reference_m",
          fmt::format("{} x {}", given.height, given.width),
          fmt::format("must equal the scene's {} x {}", scene.height(), scene.width()));
  return given;
}

}  // namespace

void RepeatedDepthOptions::validate() const {
  require(outlier_threshold_m >= 0.0, "outlier_threshold_m", outlier_threshold_m, "must be >= 0");
}

RepeatedDepth repeated_depth(const SceneImage& scene, const CodeSet& code, const Camera& camera,
                             const CaptureOptions& capture, const RepeatedDepthOptions& options,
                             const Progress& progress) {
  options.validate();
  const ForwardModel model(code, camera);
  const RowCapture source(scene, model, camera, capture);
  const AnyDecoder decoder = make_decoder(options.method, make_decoding_table(model, camera));
  const Image<float> reference_m = reference_of(scene, camera, options);
  const int height = scene.height(), width = scene.width();

  RepeatedDepth result;
  result.frames = capture.frames;
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  result.mean_m = result.standard_deviation_m = result.mean_abs_error_m = result.outlier_rate =
      Image<float>(height, width, unknown);

  const auto size_of_error = [&](double decoded_m, double truth_m) {
    return std::abs(options.error == DepthErrorKind::linear
                        ? decoded_m - truth_m
                        : circular_difference(decoded_m, truth_m, camera.range_m()));
  };
  const auto measure_row = [&](int row) {
    const auto columns = static_cast<std::size_t>(width);
    std::vector<PixelStatistics> pixels(columns);
    std::vector<float> raw(columns * static_cast<std::size_t>(source.measurements()));
    std::vector<double> depth_bin(columns);
    for (int frame = 0; frame < capture.frames; ++frame) {
      source.row(frame, row, raw.data());
      std::visit([&](const auto& d) { d.decode_depth_bins(raw.data(), width, depth_bin.data()); },
                 decoder);
      for (int column = 0; column < width; ++column) {
        PixelStatistics& pixel = pixels[static_cast<std::size_t>(column)];
        const double decoded_m = depth_bin[static_cast<std::size_t>(column)] * camera.bin_m();
        const double error_m = size_of_error(decoded_m, reference_m(row, column));
        pixel.depth_m.add(decoded_m);
        pixel.error_m.add(error_m);
        pixel.outlier.add(error_m > options.outlier_threshold_m);
      }
    }
    for (int column = 0; column < width; ++column) {
      if (!std::isfinite(scene.depth_m(row, column))) continue;
      const PixelStatistics& pixel = pixels[static_cast<std::size_t>(column)];
      result.mean_m(row, column) = static_cast<float>(pixel.depth_m.mean());
      result.standard_deviation_m(row, column) =
          static_cast<float>(std::sqrt(pixel.depth_m.variance()));
      if (!std::isfinite(reference_m(row, column))) continue;
      result.mean_abs_error_m(row, column) = static_cast<float>(pixel.error_m.mean());
      result.outlier_rate(row, column) = static_cast<float>(pixel.outlier.mean());
    }
  };

  constexpr int rows_between_reports = 8;
  for (int top = 0; top < height; top += rows_between_reports) {
    report(progress, static_cast<double>(top) / height, "repeated capture");
    const int rows = std::min(rows_between_reports, height - top);
    parallel_for(rows, [&](std::int64_t r) { measure_row(top + static_cast<int>(r)); });
  }
  report(progress, 1.0, "repeated capture");
  return result;
}

}  // namespace tofsmith
