// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/motion_error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulate/pixel_trials.hpp"

namespace tofsmith {

Eigen::VectorXd exposure_shifts_m(const CodeSet& code, const Camera& camera,
                                  double velocity_m_per_s) {
  Camera timed = camera;
  timed.exposure_s.each_s = exposure_times_s(code, camera);
  return exposure_shifts_m(timed, velocity_m_per_s);
}

Eigen::VectorXd exposure_shifts_m(const Camera& timed, double velocity_m_per_s) {
  const auto exposures = static_cast<int>(timed.exposure_s.each_s.size());
  Eigen::VectorXd shift_m(exposures);
  for (int e = 0; e < exposures; ++e)
    shift_m[e] = velocity_m_per_s *
                 (timed.exposure_middle_s(0, e, exposures) - timed.frame_middle_s(0, exposures));
  return shift_m;
}

MotionBias::MotionBias(const ForwardModel& model, const Camera& camera)
    : mean_share_(Eigen::VectorXd::Zero(model.exposures())),
      mean_product_(Eigen::MatrixXd::Zero(model.exposures(), model.exposures())) {
  const Eigen::Index cells = default_cells_per_bin(model) * model.samples();
  const Eigen::Index side = model.measurements() / model.exposures();
  for_each_depth_cell(
      model, camera, cells, [&](Eigen::Index, double mass, const auto& by_depth, const auto& part) {
        const Eigen::VectorXd of_measurements =
            part.across.cwiseProduct(by_depth) / (part.length * part.length);
        const Eigen::VectorXd share =
            of_measurements.reshaped(side, model.exposures()).colwise().sum().transpose();
        mean_share_ += mass * share;
        mean_product_ += mass * share * share.transpose();
      });
}

double MotionBias::rms_m(const Eigen::VectorXd& shift_m) const {
  return std::sqrt(std::max(0.0, shift_m.dot(mean_product_ * shift_m)));
}

namespace {

/// Surface that an exposure sees.
struct SeenSurface {
  double depth_m = 0.0;
  double signal_e_per_s = 0.0;

  friend bool operator==(const SeenSurface&, const SeenSurface&) = default;
};

/// Surfaces that the exposures of a trial see, and the depths that count as correct.
struct SeenSurfaces {
  std::vector<SeenSurface> of_exposure;
  TrueDepths true_m{};
};

MotionErrors summarized(const std::vector<PixelSums>& sums,
                        const std::vector<OperatingPoint>& points) {
  MotionErrors errors;
  std::vector<Estimate> circular_m;
  std::vector<WrongShares> shares;
  for (std::size_t p = 0; p < points.size(); ++p) {
    errors.points.push_back({.point = points[p],
                             .circular_mde_m = sums[p].circular_m.estimate(),
                             .bias_m = sums[p].bias_m.estimate(),
                             .shares = sums[p].shares()});
    circular_m.push_back(errors.points.back().circular_mde_m);
    shares.push_back(errors.points.back().shares);
  }
  errors.geometric_mean_m = geometric_mean_of(circular_m);
  errors.shares = mean_shares(shares);
  return errors;
}

/// Trials with moving surfaces.
class MotionTrials {
 public:
  MotionTrials(const CodeSet& code, const Camera& camera, const EvaluateOptions& options)
      : trials_(code, camera, options), points_(camera.operating.points()) {}

  const ForwardModel& model() const { return trials_.model(); }
  MotionErrors of_surface(const Eigen::VectorXd& shift_m, const Progress& progress) const;
  MotionErrors of_edge(const Progress& progress) const;

 private:
  /// @param draw  surfaces of a trial: (random, quantile of the first depth, signal, surfaces)
  template <typename Draw>
  MotionErrors errors_of(std::size_t first_stream, const Draw& draw,
                         const Progress& progress) const;
  void capture(const SeenSurfaces& seen, double ambient_e_per_s, RandomStream& random,
               float* raw) const;
  SeenSurface draw_surface(double quantile, double signal_e_per_s, RandomStream& random) const {
    const auto [depth_m, its_e_per_s] = trials_.draw_surface(quantile, signal_e_per_s, random);
    return {depth_m, its_e_per_s};
  }
  std::size_t exposures() const { return static_cast<std::size_t>(model().exposures()); }

  PixelTrials trials_;
  std::vector<OperatingPoint> points_;
};

/// Exposes the taps of each exposure to the surface that the exposure sees.
void MotionTrials::capture(const SeenSurfaces& seen, double ambient_e_per_s, RandomStream& random,
                           float* raw) const {
  const PixelCapture& pixel = trials_.pixel();
  const auto taps = static_cast<std::size_t>(pixel.tap_values()), side = taps / exposures();
  std::vector<double> work(taps), of_surface(taps), light(taps);
  for (std::size_t e = 0; e < exposures(); ++e) {
    const SeenSurface& surface = seen.of_exposure[e];
    if (e == 0 || !(surface == seen.of_exposure[e - 1])) {
      std::fill(of_surface.begin(), of_surface.end(), 0.0);
      pixel.add_light(surface.depth_m, surface.signal_e_per_s, work, of_surface);
    }
    std::copy_n(of_surface.data() + e * side, side, light.data() + e * side);
  }
  pixel.expose(ambient_e_per_s, random, light, raw);
}

template <typename Draw>
MotionErrors MotionTrials::errors_of(std::size_t first_stream, const Draw& draw,
                                     const Progress& progress) const {
  const auto trial = [&](RandomStream& random, double quantile, const OperatingPoint& point,
                         float* raw) {
    SeenSurfaces seen;
    draw(random, quantile, point.signal_e_per_s, seen);
    capture(seen, point.ambient_e_per_s, random, raw);
    return seen.true_m;
  };
  return summarized(trials_.run(first_stream, trial, "motion", progress), points_);
}

MotionErrors MotionTrials::of_surface(const Eigen::VectorXd& shift_m,
                                      const Progress& progress) const {
  return errors_of(
      0,
      [&](RandomStream& random, double quantile, double signal_e_per_s, SeenSurfaces& seen) {
        const SeenSurface surface = draw_surface(quantile, signal_e_per_s, random);
        seen.true_m.fill(surface.depth_m);
        for (const double by_m : shift_m)
          seen.of_exposure.push_back({surface.depth_m + by_m, surface.signal_e_per_s});
      },
      progress);
}

MotionErrors MotionTrials::of_edge(const Progress& progress) const {
  return errors_of(
      points_.size(),
      [&](RandomStream& random, double quantile, double signal_e_per_s, SeenSurfaces& seen) {
        const SeenSurface first = draw_surface(quantile, signal_e_per_s, random);
        const SeenSurface second = draw_surface(random.uniform(), signal_e_per_s, random);
        const double passes_after = 1.0 + random.uniform() * static_cast<double>(exposures() - 1);
        seen.true_m = {first.depth_m, second.depth_m};
        seen.of_exposure.assign(exposures(), second);
        std::fill_n(seen.of_exposure.begin(), static_cast<std::size_t>(passes_after), first);
      },
      progress);
}

}  // namespace

MotionReport motion_error(const CodeSet& code, const Camera& on, double velocity_m_per_s,
                          const EvaluateOptions& options, const Progress& progress) {
  options.validate();
  const Camera camera = judged_camera(on);
  const MotionTrials trials(code, camera, options);
  const ProgressParts parts(progress, 2);
  // The exposures of the judged camera are longer, because it adds neighbours.
  const Eigen::VectorXd shift_m = exposure_shifts_m(code, on, velocity_m_per_s);
  const MotionBias bias(trials.model(), camera);
  MotionReport result{.velocity_m_per_s = velocity_m_per_s,
                      .rms_bias_m = bias.rms_m(shift_m),
                      .mean_bias_m = bias.mean_m(shift_m),
                      .surface = trials.of_surface(shift_m, parts[0])};
  if (bias.exposures() > 1) result.edge = trials.of_edge(parts[1]);
  report(progress, 1.0, "motion");
  return result;
}

}  // namespace tofsmith
