// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/capture.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/simulate/fine_correlation.hpp"
#include "tofsmith/simulate/noise.hpp"

namespace tofsmith {

namespace {

/// Expected electrons, noise and read-out of one pixel at a time.
class PixelCapture {
 public:
  PixelCapture(const ForwardModel& model, const Camera& camera)
      : camera_(camera),
        correlation_(model),
        noise_(camera.sensor),
        exposure_s_(model.tap_exposure_s()),
        ambient_gain_(model.tap_ambient_gain()) {}

  int tap_values() const { return correlation_.tap_values(); }

  /// @param work  (tap values), overwritten
  void operator()(double depth_m, double signal_e_per_s, double ambient_e_per_s,
                  RandomStream& random, std::vector<double>& work, float* raw) const {
    const double position_bin =
        std::isnan(depth_m) ? 0.0 : wrap(depth_m, camera_.range_m()) / camera_.bin_m();
    correlation_.at(position_bin, work.data());
    const double dark_e_per_s = camera_.sensor.dark_current_e_per_s;
    for (std::size_t j = 0; j < work.size(); ++j) {
      const auto i = static_cast<Eigen::Index>(j);
      const double expected_e =
          exposure_s_[i] *
          (signal_e_per_s * work[j] + ambient_e_per_s * ambient_gain_[i] + dark_e_per_s);
      work[j] = noise_.convert(noise_.draw_electrons(expected_e, random));
    }
    noise_.read_out(work.data(), tap_values());
    for (int i = 0; i < noise_.measurements(tap_values()); ++i)
      raw[i] = static_cast<float>(work[static_cast<std::size_t>(i)]);
  }

 private:
  const Camera& camera_;
  FineCorrelation correlation_;
  PixelNoise noise_;
  const Eigen::VectorXd& exposure_s_;
  const Eigen::VectorXd& ambient_gain_;
};

}  // namespace

void CaptureOptions::validate() const {
  require(std::isfinite(signal_e_per_s) && signal_e_per_s >= 0.0, "signal_e_per_s", signal_e_per_s,
          "must be finite and >= 0");
  require(std::isfinite(ambient_e_per_s) && ambient_e_per_s >= 0.0, "ambient_e_per_s",
          ambient_e_per_s, "must be finite and >= 0");
  require(std::isfinite(reference_distance_m) && reference_distance_m > 0.0, "reference_distance_m",
          reference_distance_m, "must be finite and > 0");
  require(frames >= 1, "frames", frames, "must be >= 1");
}

double pixel_signal_e_per_s(const SceneImage& scene, int row, int column,
                            const CaptureOptions& options) {
  const double depth_m = scene.depth_m(row, column);
  if (std::isnan(depth_m)) return 0.0;
  const double reflected = options.signal_e_per_s * scene.albedo(row, column);
  if (!options.falloff) return reflected;
  const double distance = depth_m / options.reference_distance_m;
  return reflected * scene.cosine(row, column) / (distance * distance);
}

RawFrames capture(const SceneImage& scene, const CodeSet& code, const Camera& camera,
                  const CaptureOptions& options, const Progress& progress) {
  scene.validate();
  options.validate();
  const ForwardModel model(code, camera);
  const PixelCapture pixel(model, camera);

  RawFrames raw;
  raw.frames = options.frames;
  raw.height = scene.height();
  raw.width = scene.width();
  raw.measurements = model.measurements();
  const auto row_values =
      static_cast<std::size_t>(raw.width) * static_cast<std::size_t>(raw.measurements);
  raw.values.resize(row_values * static_cast<std::size_t>(raw.height) *
                    static_cast<std::size_t>(raw.frames));

  const auto capture_row = [&](int frame, int row) {
    std::vector<double> work(static_cast<std::size_t>(pixel.tap_values()));
    float* values = raw.frame(frame) + static_cast<std::size_t>(row) * row_values;
    for (int column = 0; column < raw.width; ++column, values += raw.measurements) {
      const auto item = static_cast<std::uint64_t>(row) * static_cast<std::uint64_t>(raw.width) +
                        static_cast<std::uint64_t>(column);
      RandomStream random(options.seed, item, static_cast<std::uint32_t>(frame));
      const double ambient_scale =
          scene.ambient_scale.empty() ? 1.0 : scene.ambient_scale(row, column);
      pixel(scene.depth_m(row, column), pixel_signal_e_per_s(scene, row, column, options),
            options.ambient_e_per_s * ambient_scale, random, work, values);
    }
  };

  constexpr int rows_between_reports = 64;
  for (int frame = 0; frame < raw.frames; ++frame) {
    for (int top = 0; top < raw.height; top += rows_between_reports) {
      report(progress, (frame + static_cast<double>(top) / raw.height) / raw.frames, "capture");
      const int rows = std::min(rows_between_reports, raw.height - top);
      parallel_for(rows, [&](std::int64_t r) { capture_row(frame, top + static_cast<int>(r)); });
    }
  }
  report(progress, 1.0, "capture");
  return raw;
}

}  // namespace tofsmith
