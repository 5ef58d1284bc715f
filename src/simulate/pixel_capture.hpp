// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/shared/random.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

struct NoiseParts {
  NoiseModel model;
  bool subtracts, is_signed;
  double read_noise_e;
  double full_well_e;  ///< infinite: no limit
  bool has_adc;
  double gain_e_per_dn = 1.0, black_level_dn = 0.0, min_dn = 0.0, max_dn = 0.0;
};

/// Converts the expected electrons of a tap to the raw number that leaves the sensor:
///   1. draw     Poisson electrons plus Gaussian read noise; or, with NoiseModel::gaussian, one
///              Gaussian of the same mean and variance, mu + sigma_r^2; both may be negative;
///   2. clip     at full_well_e, if it is set;
///   3. convert  round(electrons / gain_e_per_dn + black_level_dn), clipped to [0, 2^bits - 1], if
///              adc_bits is set, otherwise electrons;
///   4. read     every tap, or the difference of each pair of buckets.
/// The difference of the two taps of a mixer is drawn, clipped on both sides, converted and read.
/// For rows, every time bin is drawn without read noise, which is added to the rows.
class PixelNoise {
 public:
  explicit PixelNoise(const Sensor& sensor);

  /// Step 1. @param expected_e  >= 0
  double draw_electrons(double expected_e, RandomStream& random) const;
  /// Omits read noise.
  double draw_count(double expected_e, RandomStream& random) const;
  /// Draws the signal of a mixer from the expected electrons of its two taps, with mean a - b,
  /// variance a + b, and read noise. If neither is negative, both are Poisson, which is exact for
  /// weights that switch. Analog weights make smaller steps: if b < 0, the result is (a - b) / s
  /// Poisson electrons of size s = (a + b) / (a - b) each; similarly if a < 0.
  double draw_difference(double a, double b, RandomStream& random) const;
  double read_noise_e() const { return parts_.read_noise_e; }
  /// Steps 2 and 3 for one tap: [e] or [DN].
  double convert(double electrons) const;
  /// Step 4 in place.
  /// @param raw  (tap values) in, (measurements) out
  void read_out(double* raw, int tap_values) const;
  int measurements(int tap_values) const { return parts_.subtracts ? tap_values / 2 : tap_values; }

 private:
  NoiseParts parts_;
};

/// Poisson electrons of a mixer: expected numbers of both signs, and size of each.
struct SignedElectrons {
  double plus = 0.0, minus = 0.0, size = 1.0;

  static SignedElectrons of(double mean, double variance) {
    if (std::abs(mean) <= variance) return {0.5 * (variance + mean), 0.5 * (variance - mean), 1.0};
    const double size = std::max(variance, 0.0) / std::abs(mean);
    if (size < 1e-12) return {0.0, 0.0, 0.0};
    return {std::max(mean, 0.0) / size, std::max(-mean, 0.0) / size, size};
  }
};

/// chi of all tap values, tabulated much finer than bins with linear interpolation.
///
/// The interpolation error is at most max|chi''| / (8 points^2), and |slope change| / (4 points) in
/// a cell with a corner of chi (none if corners are at table points). At 10 f0 and N = 240 it is
/// below 2e-5, or 0.02 mm at a range of 10 m.
class FineCorrelation {
 public:
  static constexpr int least_points_per_bin = 16;

  /// Uses ForwardModel::straight_points_per_bin().
  explicit FineCorrelation(const ForwardModel& model);
  FineCorrelation(const ForwardModel& model, int points_per_bin);
  /// Accepts any table of tap values, (points, tap values).
  FineCorrelation(const Eigen::MatrixXd& table, int points_per_bin);

  int tap_values() const { return tap_values_; }
  /// Per period.
  int points() const { return points_; }
  double points_per_bin() const { return points_per_bin_; }
  /// The table with the first row repeated, (points + 1, tap values). Rows of an exposure have one
  /// column, of time bin 0; bin n equals bin 0 at a depth n bins nearer.
  const std::vector<double>& table() const { return table_; }
  /// @param depth_bin  in [0, N]; @param chi  (tap values)
  void at(double depth_bin, double* chi) const;

 private:
  int tap_values_;
  int points_;
  double points_per_bin_;
  bool is_time_bin_ = false;
  std::vector<double> table_;
};

/// Simulates expected electrons, noise and read-out of one pixel at a time.
class PixelCapture {
 public:
  PixelCapture(const ForwardModel& model, const Camera& camera);

  int measurements() const {
    return rows_ ? static_cast<int>(rows_->rows()) : noise_.measurements(correlation_.tap_values());
  }
  int tap_values() const { return correlation_.tap_values(); }

  /// Adds S chi of one return to `light` (tap values).
  /// @param depth_m  wraps at the range; NaN: no return, requires signal_e_per_s = 0
  /// @param work  (tap values), overwritten
  void add_light(const FineCorrelation& correlation, double depth_m, double signal_e_per_s,
                 std::vector<double>& work, std::vector<double>& light) const;
  void add_light(double depth_m, double signal_e_per_s, std::vector<double>& work,
                 std::vector<double>& light) const {
    add_light(correlation_, depth_m, signal_e_per_s, work, light);
  }
  /// Exposes the sensor to the sum of all returns.
  /// @param light  overwritten
  /// @param raw  (measurements), overwritten
  void expose(double ambient_e_per_s, RandomStream& random, std::vector<double>& light,
              float* raw) const;

 private:
  double range_m_, bin_m_;
  double dark_e_per_s_;
  bool is_signed_;
  FineCorrelation correlation_;
  PixelNoise noise_;
  Eigen::VectorXd exposure_s_, ambient_gain_;  // per tap value
  std::optional<Eigen::MatrixXd> rows_;        // (K, N), for rows
};

/// Captures a scene, which must outlive this object, row by row.
class RowCapture {
 public:
  /// @throws std::invalid_argument if scene or options are invalid
  RowCapture(const SceneImage& scene, const ForwardModel& model, const Camera& camera,
             const CaptureOptions& options);
  RowCapture(const SceneImage& scene, const SceneLight& light, const ForwardModel& model,
             const Camera& camera, const CaptureOptions& options);

  /// Changes to another scene with the same camera.
  /// @param light  validated; both must outlive this object
  void see(const SceneImage& scene, const SceneLight& light, const ForwardModel& model,
           const Camera& camera);

  int measurements() const { return pixel_.measurements(); }
  int tap_values() const { return pixel_.tap_values(); }
  const SceneImage& scene() const { return *scene_; }
  /// Returns one row of one frame, (W, K).
  void row(int frame, int row, float* raw) const;

  // In two steps, for pixels that receive the light of several rays.

  /// Computes S chi of every tap value, for all returns.
  /// @param work, light  (tap values), overwritten
  void light_at(int row, int column, std::vector<double>& work, std::vector<double>& light) const;
  double ambient_e_per_s(int row, int column) const;
  double ambient_e_per_s() const { return options_.ambient_e_per_s; }
  /// @param pixel  index in the frame
  /// @param light  overwritten
  void expose(int frame, std::uint64_t pixel, double ambient_e_per_s, std::vector<double>& light,
              float* raw) const;

 private:
  void add_all_light(int row, int column, std::vector<double>& work,
                     std::vector<double>& light) const;

  const SceneImage* scene_;
  const SceneLight* light_ = nullptr;  // null: direct light only
  double bin_m_;
  CaptureOptions options_;
  PixelCapture pixel_;
  std::optional<FineCorrelation> tail_, transient_;
};

/// Light on the pixels of a frame before noise [e/s], and the distances of its sources.
struct CollectedLight {
  int height = 0, width = 0;
  int tap_values = 0;
  std::vector<double> taps;     ///< (H, W, tap values): S chi
  std::vector<double> ambient;  ///< (H, W); empty: uniform
  Image<float> near_m, far_m;   ///< of contributing distances; NaN: none

  CollectedLight(int height_, int width_, int tap_values_);
};

RawFrames empty_frames(int frames, int height, int width, int measurements);

}  // namespace tofsmith
