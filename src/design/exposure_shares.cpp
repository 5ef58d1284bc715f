// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/exposure_shares.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "camera/shared/depth_prior.hpp"
#include "simulate/shared/depth_information.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

double free_share(Eigen::Index exposures) {
  return 1.0 - static_cast<double>(exposures) * min_exposure_share;
}

/// Scales positive shares to the sum 1, with the smallest ones at min_exposure_share.
Eigen::VectorXd with_smallest_shares(Eigen::VectorXd shares) {
  const Eigen::ArrayXd wanted = shares / shares.sum();
  Eigen::Array<bool, Eigen::Dynamic, 1> smallest = wanted < min_exposure_share;
  // Scaling the others may bring more shares to the smallest one.
  for (Eigen::Index round = 0; round < shares.size(); ++round) {
    const double left = 1.0 - min_exposure_share * static_cast<double>(smallest.count());
    const double scale = left / smallest.select(0.0, wanted).sum();
    shares = smallest.select(min_exposure_share, scale * wanted);
    smallest = smallest || shares.array() < min_exposure_share;
  }
  return shares;
}

Eigen::VectorXd equal_shares(Eigen::Index exposures) {
  return Eigen::VectorXd::Constant(exposures, 1.0 / static_cast<double>(exposures));
}

}  // namespace

Eigen::VectorXd shares_of_logits(const Eigen::VectorXd& logits) {
  const Eigen::ArrayXd weights = (logits.array() - logits.maxCoeff()).exp();
  return min_exposure_share + free_share(logits.size()) / weights.sum() * weights;
}

Eigen::VectorXd logits_of_shares(const Eigen::VectorXd& shares) {
  constexpr double smallest = 1e-4;
  const Eigen::ArrayXd logits = (shares.array() - min_exposure_share).max(smallest).log();
  return logits - logits.mean();
}

Eigen::VectorXd pull_back_shares(const Eigen::VectorXd& shares, const Eigen::VectorXd& by_shares) {
  const Eigen::ArrayXd weights = shares.array() - min_exposure_share;
  const double mean = (weights * by_shares.array()).sum() / free_share(shares.size());
  return weights * (by_shares.array() - mean);
}

Eigen::VectorXd minimize_over_shares(Eigen::VectorXd shares, const ShareObjective& objective) {
  constexpr int max_evaluations = 100;
  constexpr double converged = 1e-4;  // relative change
  constexpr double min_exponent = 0.01, max_exponent = 2.0;
  double exponent = 0.5;
  Eigen::VectorXd gradient, next_gradient;
  double value = objective(shares, gradient);
  for (int i = 0; i < max_evaluations && exponent > min_exponent; ++i) {
    const Eigen::ArrayXd gain = (-gradient).array().max(0.0);
    if (!gain.allFinite() || gain.maxCoeff() <= 0.0) break;
    const Eigen::ArrayXd factor = (gain / gain.maxCoeff()).max(1e-12).pow(exponent);
    Eigen::VectorXd next = with_smallest_shares(shares.array() * factor);
    const double next_value = objective(next, next_gradient);
    if (!(next_value < value)) {
      exponent *= 0.5;
      continue;
    }
    const double change = (next.array() / shares.array()).log().abs().maxCoeff();
    shares = std::move(next);
    value = next_value;
    std::swap(gradient, next_gradient);
    exponent = std::min(max_exponent, 1.5 * exponent);
    if (change < converged) break;
  }
  return shares;
}

Eigen::VectorXd shares_of(const CodeSet& code) {
  const std::vector<double>& shares = code.exposure_shares();
  if (shares.empty()) return equal_shares(code.exposures());
  return Eigen::Map<const Eigen::VectorXd>(shares.data(), std::ssize(shares));
}

ExposureBound::ExposureBound(const CodeSet& code, const Camera& on)
    : exposures_(code.exposures()),
      root_mean_square_(on.operating.statistic == ErrorStatistic::rmse),
      points_(on.operating.points()) {
  require(on.exposure_s.each_s.empty(), "exposure_s", "a list",
          "must be one time, which the exposures share");
  const Camera camera = judged_camera(on);
  total_s_ = camera.exposure_s.total_s;
  range_m_ = camera.range_m();
  constexpr int albedos = 12;  // denser near 0, where the bound grows
  for (int i = 0; i < (camera.operating.uniform_albedo ? albedos : 1); ++i) {
    const double x = (i + 0.5) / albedos;
    albedos_.push_back(camera.operating.uniform_albedo ? x * x : camera.operating.albedo);
    albedo_weights_.push_back(camera.operating.uniform_albedo ? 2.0 * x / albedos : 1.0);
  }

  const ForwardModel model(code.with_exposure_shares({}), camera);
  const int depths = model.samples();
  const Eigen::MatrixXd taps = model.tap_correlation_table(2 * depths);
  const Eigen::MatrixXd& readout = model.readout();
  const Eigen::MatrixXd sums = readout.cwiseAbs();
  middles_and_slopes(taps * readout.transpose(), signal_, slope_);
  shot_signal_.resize(depths, sums.rows());
  for (int j = 0; j < depths; ++j) shot_signal_.row(j) = taps.row(2 * j + 1) * sums.transpose();
  shot_ambient_ = sums * model.tap_ambient_gain();
  ambient_ = unknown_ambient_gain(model, camera);
  ambient_ = (ambient_.array().abs() > 1e-9 * shot_ambient_.array()).select(ambient_, 0.0);
  dark_variance_e2_per_s_ = model.tap_dark_e_per_s() * sums.rowwise().sum();
  constant_variance_e2_ = model.constant_variance_e2();
  masses_ = DepthPrior(camera).masses(depths);
  if (masses_.size() == 0) masses_ = equal_shares(depths);

  std::vector<Eigen::Index> order(static_cast<std::size_t>(exposures_));
  std::iota(order.begin(), order.end(), 0);
  if (camera.playback && !camera.playback->order.empty())
    order.assign(camera.playback->order.begin(), camera.playback->order.end());
  const Eigen::Index per_exposure = signal_.cols() / exposures_;
  for (Eigen::Index i = 0; i < signal_.cols(); ++i)
    exposure_of_.push_back(order[static_cast<std::size_t>(i / per_exposure)]);
}

ExposureBound::Level ExposureBound::level(const OperatingPoint& point,
                                          const Eigen::VectorXd& shares) const {
  const Eigen::Index K = signal_.cols();
  const double power = root_mean_square_ ? 2.0 : 1.0;
  Level result{0.0, Eigen::VectorXd::Zero(exposures_)};
  Eigen::VectorXd by_depth(K), by_signal(K), by_ambient(K), by_time(K);
  double sum = 0.0;
  for (std::size_t a = 0; a < albedos_.size(); ++a) {
    const double signal = albedos_[a] * point.signal_e_per_s;
    for (Eigen::Index z = 0; z < masses_.size(); ++z) {
      const double weight = albedo_weights_[a] * masses_[z];
      if (weight == 0.0) continue;
      for (Eigen::Index i = 0; i < K; ++i) {
        const double time_s = total_s_ * shares[exposure_of_[static_cast<std::size_t>(i)]];
        const double rate = signal * shot_signal_(z, i) + point.ambient_e_per_s * shot_ambient_[i] +
                            dark_variance_e2_per_s_[i];
        const double variance = std::max(min_e2, time_s * rate + constant_variance_e2_[i]);
        const double root = time_s / std::sqrt(variance);
        by_depth[i] = root * signal * slope_(z, i);
        by_signal[i] = root * signal_(z, i);
        by_ambient[i] = root * ambient_[i];
        by_time[i] = 2.0 / time_s - rate / variance;  // d log w / dT
      }
      const DepthPart<Eigen::VectorXd> part(by_depth, by_signal, by_ambient);
      const double information = part.length * part.length + 12.0;  // [1 / period^2]
      const double deviation_m = range_m_ / std::sqrt(information);
      const double contribution = weight * std::pow(deviation_m, power);
      sum += contribution;
      if (part.length == 0.0) continue;
      // |across|^2 = sum w r^2 is minimal over r, so its derivative by log w is across^2.
      for (Eigen::Index i = 0; i < K; ++i)
        result.by_shares[exposure_of_[static_cast<std::size_t>(i)]] -=
            0.5 * contribution * part.across[i] * part.across[i] * by_time[i] / information;
    }
  }
  result.log_deviation = std::log(sum) / power;
  result.by_shares *= total_s_ / sum;
  return result;
}

double ExposureBound::log_deviation(const Eigen::VectorXd& shares,
                                    Eigen::VectorXd& by_shares) const {
  std::vector<Level> levels(points_.size());
  parallel_for_indices(points_.size(),
                       [&](std::size_t at) { levels[at] = level(points_[at], shares); });
  const auto count = static_cast<double>(levels.size());
  double sum = 0.0;
  by_shares = Eigen::VectorXd::Zero(exposures_);
  for (const Level& its : levels) {
    sum += its.log_deviation / count;
    by_shares += its.by_shares / count;
  }
  return sum;
}

double ExposureBound::log_deviation(const Eigen::VectorXd& shares) const {
  Eigen::VectorXd unused;
  return log_deviation(shares, unused);
}

Eigen::VectorXd ExposureBound::best_shares() const {
  return minimize_over_shares(equal_shares(exposures_),
                              [&](const Eigen::VectorXd& shares, Eigen::VectorXd& by_shares) {
                                return log_deviation(shares, by_shares);
                              });
}

double ExposureBound::gain(const Eigen::VectorXd& shares) const {
  return std::exp(log_deviation(equal_shares(exposures_)) - log_deviation(shares));
}

}  // namespace tofsmith
