// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/motion_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "camera/shared/depth_prior.hpp"
#include "simulate/pixel_capture.hpp"
#include "simulate/shared/depth_information.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"

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
  Eigen::MatrixXd signal, slope;
  middles_and_slopes(
      model.correlation_table(static_cast<int>(2 * cells)) * model.exposure_s().asDiagonal(),
      signal, slope);
  const Eigen::VectorXd ambient =
      model.exposure_s().cwiseProduct(unknown_ambient_gain(model, camera));
  const Eigen::VectorXd masses = DepthPrior(camera).masses(cells);
  const Eigen::Index side = model.measurements() / model.exposures();
  for (Eigen::Index j = 0; j < cells; ++j) {
    const Eigen::VectorXd by_depth = slope.row(j);
    const DepthPart<Eigen::VectorXd> depth(by_depth, signal.row(j), ambient);
    if (!(depth.length > 0.0)) continue;  // no depth can be decoded
    const Eigen::VectorXd of_measurements =
        depth.across.cwiseProduct(by_depth) / (depth.length * depth.length);
    const Eigen::VectorXd share =
        of_measurements.reshaped(side, model.exposures()).colwise().sum().transpose();
    const double mass = masses.size() > 0 ? masses[j] : 1.0 / static_cast<double>(cells);
    mean_share_ += mass * share;
    mean_product_ += mass * share * share.transpose();
  }
}

double MotionBias::rms_m(const Eigen::VectorXd& shift_m) const {
  return std::sqrt(std::max(0.0, shift_m.dot(mean_product_ * shift_m)));
}

std::optional<double> WrongShares::detected() const {
  if (!(wrong > 0.0)) return std::nullopt;
  return wrong_inconsistent / wrong;
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
  std::array<double, 2> true_m{};
};

/// Sums of the results of trials.
struct MotionSums {
  RunningStatistics error_m, bias_m;
  std::int64_t wrong = 0, wrong_ok = 0, wrong_inconsistent = 0, inconsistent = 0;

  void add(const std::array<double, 2>& true_m, double depth_m, double deviation_m,
           PixelStatus status, double range_m);
  MotionPoint at(const OperatingPoint& point) const;
};

void MotionSums::add(const std::array<double, 2>& true_m, double depth_m, double deviation_m,
                     PixelStatus status, double range_m) {
  inconsistent += status == PixelStatus::inconsistent;
  if (std::isnan(depth_m)) {
    error_m.add(0.25 * range_m);  // the mean error of a guess
    return;
  }
  const double first_m = circular_difference(depth_m, true_m[0], range_m);
  const double second_m = circular_difference(depth_m, true_m[1], range_m);
  const double nearest_m = std::abs(second_m) < std::abs(first_m) ? second_m : first_m;
  error_m.add(std::abs(nearest_m));
  bias_m.add(nearest_m);
  if (!(std::abs(nearest_m) > 3.0 * deviation_m)) return;
  ++wrong;
  wrong_ok += status == PixelStatus::ok;
  wrong_inconsistent += status == PixelStatus::inconsistent;
}

MotionPoint MotionSums::at(const OperatingPoint& point) const {
  const auto share = [&](std::int64_t count) {
    return static_cast<double>(count) / static_cast<double>(error_m.count());
  };
  return {.point = point,
          .circular_mde_m = error_m.estimate(),
          .bias_m = bias_m.estimate(),
          .shares = {.wrong = share(wrong),
                     .wrong_ok = share(wrong_ok),
                     .wrong_inconsistent = share(wrong_inconsistent),
                     .inconsistent = share(inconsistent)}};
}

MotionErrors summarized(std::vector<MotionPoint> points) {
  MotionErrors errors;
  std::vector<Estimate> circular_m;
  const auto count = static_cast<double>(points.size());
  for (const MotionPoint& p : points) {
    circular_m.push_back(p.circular_mde_m);
    for (const auto share : {&WrongShares::wrong, &WrongShares::wrong_ok,
                             &WrongShares::wrong_inconsistent, &WrongShares::inconsistent})
      errors.shares.*share += p.shares.*share / count;
  }
  errors.geometric_mean_m = geometric_mean_of(circular_m);
  errors.points = std::move(points);
  return errors;
}

/// Draws and decodes trials.
class MotionTrials {
 public:
  MotionTrials(const CodeSet& code, const Camera& camera, const EvaluateOptions& options)
      : camera_(camera),
        options_(options),
        depths_(camera),
        model_(code, camera),
        pixel_(model_, camera),
        decoder_(make_decoder(options.method, make_decoding_table(model_, camera), {},
                              options.unwrap_weights)) {}

  const ForwardModel& model() const { return model_; }
  MotionErrors of_surface(const Eigen::VectorXd& shift_m, const Progress& progress) const;
  MotionErrors of_edge(const Progress& progress) const;

 private:
  /// @param first_stream  number of the random stream of the first operating point
  /// @param draw  surfaces of a trial: (random, quantile of the first depth, signal, surfaces)
  template <typename Draw>
  MotionErrors errors_of(std::size_t first_stream, const Draw& draw,
                         const Progress& progress) const;
  void capture(const SeenSurfaces& seen, double ambient_e_per_s, RandomStream& random,
               float* raw) const;
  void add_decoded(const RawFrames& raw, const std::vector<SeenSurfaces>& seen,
                   MotionSums& sums) const;
  SeenSurface draw_surface(double quantile, double signal_e_per_s, RandomStream& random) const {
    const OperatingRange& operating = camera_.operating;
    const double albedo = operating.uniform_albedo ? random.uniform() : operating.albedo;
    return {depths_.quantile(quantile) * camera_.range_m(), albedo * signal_e_per_s};
  }
  std::size_t exposures() const { return static_cast<std::size_t>(model_.exposures()); }

  const Camera& camera_;
  const EvaluateOptions& options_;
  DepthPrior depths_;
  ForwardModel model_;
  PixelCapture pixel_;
  std::unique_ptr<const DepthDecoder> decoder_;
};

/// Exposes the taps of each exposure to the surface that the exposure sees.
void MotionTrials::capture(const SeenSurfaces& seen, double ambient_e_per_s, RandomStream& random,
                           float* raw) const {
  const auto taps = static_cast<std::size_t>(pixel_.tap_values()), side = taps / exposures();
  std::vector<double> work(taps), of_surface(taps), light(taps);
  for (std::size_t e = 0; e < exposures(); ++e) {
    const SeenSurface& surface = seen.of_exposure[e];
    if (e == 0 || !(surface == seen.of_exposure[e - 1])) {
      std::fill(of_surface.begin(), of_surface.end(), 0.0);
      pixel_.add_light(surface.depth_m, surface.signal_e_per_s, work, of_surface);
    }
    std::copy_n(of_surface.data() + e * side, side, light.data() + e * side);
  }
  pixel_.expose(ambient_e_per_s, random, light, raw);
}

void MotionTrials::add_decoded(const RawFrames& raw, const std::vector<SeenSurfaces>& seen,
                               MotionSums& sums) const {
  DepthImage image({DecodedPlane::depth, DecodedPlane::deviation, DecodedPlane::status}, 1,
                   raw.width);
  decoder_->decode(RawView::interleaved(raw.values.data(), 1, raw.width, raw.measurements),
                   DecodedView::of(image));
  for (std::size_t i = 0; i < seen.size(); ++i)
    sums.add(seen[i].true_m, image.depth_m.pixels[i], image.deviation_m.pixels[i],
             image.status.pixels[i], camera_.range_m());
}

template <typename Draw>
MotionErrors MotionTrials::errors_of(std::size_t first_stream, const Draw& draw,
                                     const Progress& progress) const {
  constexpr std::int64_t trials_at_once = 1 << 16;
  const std::vector<OperatingPoint> points = camera_.operating.points();
  const std::int64_t trials = options_.trials;
  std::vector<MotionPoint> results;
  const ProgressParts parts(progress, points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    MotionSums sums;
    for (std::int64_t begin = 0; begin < trials; begin += trials_at_once) {
      report(parts[p], static_cast<double>(begin) / static_cast<double>(trials), "motion");
      const std::int64_t count = std::min(trials_at_once, trials - begin);
      RawFrames raw{1, 1, static_cast<int>(count), pixel_.measurements(), {}};
      raw.values.resize(static_cast<std::size_t>(count * pixel_.measurements()));
      std::vector<SeenSurfaces> seen(static_cast<std::size_t>(count));
      parallel_for_blocks(count, 256, [&](IndexRange block) {
        for (std::int64_t i = block.begin; i < block.end; ++i) {
          const std::int64_t trial = begin + i;
          RandomStream random(options_.seed, first_stream + p, static_cast<std::uint32_t>(trial));
          SeenSurfaces& surfaces = seen[static_cast<std::size_t>(i)];
          draw(random,
               (static_cast<double>(trial) + random.uniform()) / static_cast<double>(trials),
               points[p].signal_e_per_s, surfaces);
          capture(surfaces, points[p].ambient_e_per_s, random,
                  raw.values.data() + i * pixel_.measurements());
        }
      });
      add_decoded(raw, seen, sums);
    }
    results.push_back(sums.at(points[p]));
  }
  report(progress, 1.0, "motion");
  return summarized(std::move(results));
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
      camera_.operating.points().size(),
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
                      .surface = trials.of_surface(shift_m, parts[0]),
                      .edge = {}};
  if (bias.exposures() > 1) result.edge = trials.of_edge(parts[1]);
  report(progress, 1.0, "motion");
  return result;
}

}  // namespace tofsmith
