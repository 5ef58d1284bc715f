// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/depth_error_loss.hpp"

#include <algorithm>
#include <cmath>

#include "tofsmith/core/units.hpp"

namespace tofsmith {

DepthErrorLoss::DepthErrorLoss(const SampledCamera& camera, MeasurementTable table,
                               MeasurementTimes times, DepthErrorKind kind)
    : camera_(&camera),
      table_(std::move(table)),
      correlation_of_bin_(table_.correlation.transpose()),
      shot_of_bin_(table_.shot_correlation.transpose()),
      times_(std::move(times)),
      dark_variance_e2_per_s_(camera.dark_variance_e2_per_s()),
      circular_(kind == DepthErrorKind::circular),
      curve_(camera, table_, times_.exposure_s),
      decoder_(curve_),
      curve_gradient_(curve_),
      by_exposure_s_(Eigen::VectorXd::Zero(table_.measurements())),
      by_electrons_(static_cast<std::size_t>(table_.measurements())) {
  by_light_ = {Eigen::ArrayXXd::Zero(table_.measurements(), table_.samples()),
               Eigen::ArrayXd::Zero(table_.measurements())};
  if (has_own_shot()) by_shot_light_ = by_light_;
}

double DepthErrorLoss::mean_variance_e2(const OperatingPoint& point) const {
  const Eigen::VectorXd light = point.signal_e_per_s * table_.shot().colwise().mean().transpose() +
                                point.ambient_e_per_s * table_.shot_ambient();
  return (times_.exposure_s.cwiseProduct(light) + times_.constant_variance_e2).mean();
}

DepthErrorLoss::Place DepthErrorLoss::place_at(double depth_periods, double signal_e_per_s) const {
  const int samples = table_.samples();
  const double position = depth_periods * samples;
  const int bin = std::min(static_cast<int>(position), samples - 1);
  return {bin, bin + 1 < samples ? bin + 1 : 0, position - bin, signal_e_per_s};
}

void DepthErrorLoss::add_light(const Eigen::ArrayXXd& of_bin, Eigen::ArrayXd& light_e_per_s) const {
  for (const Place& place : reading_.places)
    light_e_per_s += place.signal_e_per_s * ((1.0 - place.fraction) * of_bin.col(place.bin) +
                                             place.fraction * of_bin.col(place.next));
}

void DepthErrorLoss::read(const OperatingPoint& point, const TrialBatch& batch, std::size_t trial) {
  const DepthTrial& truth = batch.trials[trial];
  const double signal_e_per_s = truth.albedo * point.signal_e_per_s;
  reading_.places.assign(1, place_at(truth.depth_periods, signal_e_per_s));
  if (truth.multipath_ratio > 0.0)
    reading_.places.push_back(place_at(wrap(truth.depth_periods + truth.later_delay_periods, 1.0),
                                       truth.multipath_ratio * signal_e_per_s));
  Eigen::ArrayXd& light = reading_.light_e_per_s;
  light = point.ambient_e_per_s * table_.ambient_gain.array();
  add_light(correlation_of_bin_, light);
  if (has_own_shot()) {
    reading_.shot_light_e_per_s = point.ambient_e_per_s * table_.shot_ambient().array();
    add_light(shot_of_bin_, reading_.shot_light_e_per_s);
  }
  const Eigen::ArrayXd& shot_light = has_own_shot() ? reading_.shot_light_e_per_s : light;
  const auto time_s = times_.exposure_s.array();
  reading_.deviation_e =
      (time_s * shot_light + times_.constant_variance_e2.array()).max(1e-6).sqrt();
  const Eigen::Map<const Eigen::ArrayXd> normals(batch.normals_of(trial), table_.measurements());
  reading_.electrons = (time_s * light + reading_.deviation_e * normals).cast<float>();
}

void DepthErrorLoss::pull_back_reading(const OperatingPoint& point, const double* normals,
                                       double weight) {
  const int measurements = table_.measurements();
  const auto time_s = times_.exposure_s.array();
  const Eigen::Map<const Eigen::ArrayXf> by_electrons(by_electrons_.data(), measurements);
  const Eigen::ArrayXd& shot_light =
      has_own_shot() ? reading_.shot_light_e_per_s : reading_.light_e_per_s;
  BinGradients& by_shot_light = has_own_shot() ? by_shot_light_ : by_light_;
  Eigen::ArrayXd &by_mean = reading_.by_mean, &by_variance = reading_.by_variance;
  by_mean = weight * by_electrons.cast<double>() * time_s;
  by_variance = by_mean * Eigen::Map<const Eigen::ArrayXd>(normals, measurements) /
                (2.0 * reading_.deviation_e);
  by_exposure_s_.array() += (by_mean * reading_.light_e_per_s +
                             by_variance * (shot_light + dark_variance_e2_per_s_.array())) /
                            time_s;
  by_light_.ambient_gain += by_mean * point.ambient_e_per_s;
  by_shot_light.ambient_gain += by_variance * point.ambient_e_per_s;
  for (const Place& place : reading_.places) {
    const double lower = place.signal_e_per_s * (1.0 - place.fraction);
    const double upper = place.signal_e_per_s * place.fraction;
    by_light_.correlation.col(place.bin) += by_mean * lower;
    by_light_.correlation.col(place.next) += by_mean * upper;
    by_shot_light.correlation.col(place.bin) += by_variance * lower;
    by_shot_light.correlation.col(place.next) += by_variance * upper;
  }
}

SoftTwoReturnDecoder* DepthErrorLoss::two_return_decoder(const TrialBatch& batch) {
  if (!batch.two_returns) return nullptr;
  const TwoReturnGrid& grid = *batch.two_returns;
  if (!two_returns_) two_returns_.emplace(curve_, table_.samples() / grid.bins, grid.delays);
  return &*two_returns_;
}

double DepthErrorLoss::soft_error(const OperatingPoint& point, const TrialBatch& batch,
                                  double sharpness, std::optional<double> weight) {
  const double per_trial = 1.0 / static_cast<double>(batch.trials.size());
  SoftTwoReturnDecoder* const pairs = two_return_decoder(batch);
  double sum = 0.0;
  for (std::size_t t = 0; t < batch.trials.size(); ++t) {
    read(point, batch, t);
    const float* const electrons = reading_.electrons.data();
    const SoftQuestion question{batch.trials[t].depth_periods * table_.samples(), sharpness,
                                circular_};
    const double trial_weight = batch.trials[t].weight * per_trial;
    if (!weight) {
      sum += trial_weight * (pairs ? pairs->expected_error(electrons, question)
                                   : decoder_.expected_error(curve_, electrons, question));
      continue;
    }
    const double scale = *weight * trial_weight;
    const auto by_error = static_cast<float>(scale);
    sum += trial_weight *
           (pairs ? pairs->expected_error(electrons, question, by_error, by_electrons_.data())
                  : decoder_.expected_error(curve_, electrons, question, by_error, &curve_gradient_,
                                            by_electrons_.data()));
    pull_back_reading(point, batch.normals_of(t), scale);
  }
  return sum;
}

void DepthErrorLoss::decode(const OperatingPoint& point, const TrialBatch& batch,
                            std::vector<double>& decoded_bin) {
  SoftTwoReturnDecoder* const pairs = two_return_decoder(batch);
  decoded_bin.resize(batch.trials.size());
  for (std::size_t t = 0; t < batch.trials.size(); ++t) {
    read(point, batch, t);
    const float* const electrons = reading_.electrons.data();
    decoded_bin[t] = pairs ? pairs->decode(electrons) : decoder_.decode(curve_, electrons);
  }
}

MeasurementTable DepthErrorLoss::gradient(Eigen::VectorXd* by_exposure_s) const {
  MeasurementTable result;
  result.correlation = by_light_.correlation.transpose();
  result.ambient_gain = by_light_.ambient_gain;
  if (has_own_shot()) {
    result.shot_correlation = by_shot_light_.correlation.transpose();
    result.shot_ambient_gain = by_shot_light_.ambient_gain;
  }
  CurveGradient by_curve = curve_gradient_;
  if (two_returns_) two_returns_->pull_back(by_curve);
  by_curve.pull_back(*camera_, table_, curve_, result, by_exposure_s);
  if (by_exposure_s) *by_exposure_s += by_exposure_s_;
  return result;
}

StochasticGradient::StochasticGradient(const DesignProblem& problem, int trials, std::uint64_t seed,
                                       std::uint64_t work_item)
    : problem_(&problem),
      trials_(trials),
      noise_(RandomStream(seed, work_item, 0xffffffffu)) {  // differs from all step numbers
  for (const CameraVariant& variant : problem.variants)
    average_error_.emplace_back(variant.levels.size(), 0.0);
}

double StochasticGradient::mean_log(std::size_t variant) const {
  const CameraVariant& its = problem_->variants[variant];
  double sum = 0.0;
  for (std::size_t p = 0; p < its.levels.size(); ++p)
    sum += its.levels[p].weight * std::log(std::max(1e-12, average_error_[variant][p]));
  return sum / its.total_weight();
}

double StochasticGradient::weight(std::size_t variant, std::size_t point) const {
  constexpr double worst_case_sharpness = 20.0;
  double total = 0.0;
  for (std::size_t v = 0; v < average_error_.size(); ++v)
    total += std::exp(worst_case_sharpness * (mean_log(v) - mean_log(variant)));
  const CameraVariant& its = problem_->variants[variant];
  return its.levels[point].weight / (total * its.total_weight() * average_error_[variant][point]);
}

void StochasticGradient::add(std::size_t variant, std::size_t point, double error) {
  double& average = average_error_[variant][point];
  average = average > 0.0 ? 0.9 * average + 0.1 * error : error;
}

SampledCode StochasticGradient::at(const SampledCode& code, double decision_sharpness,
                                   RandomStream& random) {
  SampledCode gradient{Eigen::MatrixXd::Zero(code.modulation.rows(), code.modulation.cols()),
                       Eigen::MatrixXd::Zero(code.demodulation.rows(), code.demodulation.cols()),
                       Eigen::VectorXd::Zero(code.shares.size())};
  for (std::size_t v = 0; v < problem_->variants.size(); ++v) {
    const CameraVariant& variant = problem_->variants[v];
    const SampledCamera::Measured measured = variant.camera.measure(code);
    DepthErrorLoss loss(variant.camera, measured.table, measured.times, problem_->operating.error);
    const int trials =
        trials_ / static_cast<int>(variant.usual_levels() * problem_->variants.size());
    for (std::size_t p = 0; p < variant.levels.size(); ++p) {
      const LightLevel& level = variant.levels[p];
      const TrialBatch batch =
          draw_trials(DesignProblem::trials_of(level, trials), variant.camera.measurements(),
                      problem_->operating, problem_->linear(), random, &noise_,
                      problem_->multipath_of(level), problem_->depths);
      const double sharpness = decision_sharpness / loss.mean_variance_e2(level.point);
      if (average_error_[v][p] == 0.0)
        add(v, p, std::max(1e-9, loss.soft_error(level.point, batch, sharpness)));
      add(v, p, std::max(1e-9, loss.soft_error(level.point, batch, sharpness, weight(v, p))));
    }
    Eigen::VectorXd by_exposure_s = Eigen::VectorXd::Zero(variant.camera.measurements());
    const SampledCode part = variant.camera.pull_back(measured, loss.gradient(&by_exposure_s));
    gradient.modulation += part.modulation;
    gradient.demodulation += part.demodulation;
    if (code.shares.size() > 0) gradient.shares += variant.camera.pull_back_times(by_exposure_s);
  }
  return gradient;
}

}  // namespace tofsmith
