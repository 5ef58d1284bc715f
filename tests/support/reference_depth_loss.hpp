// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "design/optimize/sampled_camera.hpp"
#include "design/optimize/trial_batch.hpp"

namespace tofsmith {

/// Points (R, N) of the decoding curve as defined by DecodingCurve.
inline Eigen::MatrixXd reference_points(const SampledCamera& camera,
                                        const MeasurementTable& table) {
  const Eigen::VectorXd relative = camera.exposure_s() / camera.exposure_s().mean();
  const Eigen::VectorXd ambient = relative.cwiseProduct(table.ambient_gain);
  const auto count = ambient.size();
  Eigen::MatrixXd projection = Eigen::MatrixXd::Identity(count, count);
  if (camera.ambient_unknown()) projection -= ambient * ambient.transpose() / ambient.squaredNorm();
  return projection * relative.asDiagonal() * table.correlation.transpose();
}

inline Eigen::VectorXd reference_electrons(const SampledCamera& camera,
                                           const MeasurementTable& table,
                                           const OperatingPoint& point, const TrialBatch& batch,
                                           std::size_t t) {
  const int samples = table.samples(), count = table.measurements();
  const DepthTrial& trial = batch.trials[t];
  const double position = trial.depth_periods * samples;
  const double later = position + trial.later_delay_periods * samples;
  Eigen::VectorXd y(count);
  for (int i = 0; i < count; ++i) {
    const auto light = [&](const Eigen::MatrixXd& chi, const Eigen::VectorXd& kappa) {
      const auto at = [&](double bins) {
        const int bin = static_cast<int>(bins);
        const double fraction = bins - bin;
        return (1 - fraction) * chi(bin % samples, i) + fraction * chi((bin + 1) % samples, i);
      };
      return camera.exposure_s()[i] * (trial.albedo * point.signal_e_per_s *
                                           (at(position) + trial.multipath_ratio * at(later)) +
                                       point.ambient_e_per_s * kappa[i]);
    };
    const double variance =
        light(table.shot(), table.shot_ambient()) + camera.constant_variance_e2()[i];
    y[i] =
        light(table.correlation, table.ambient_gain) + std::sqrt(variance) * batch.normals_of(t)[i];
  }
  return y;
}

/// Differentiable depth error in double, trial by trial and chord by chord: the slow reference for
/// DepthErrorLoss.
/// @param decoded_bin  if not null, receives the depth of the last trial from the hard decoder
inline double reference_soft_error(const SampledCamera& camera, const MeasurementTable& table,
                                   const OperatingPoint& point, const TrialBatch& batch,
                                   double sharpness, bool circular, double* decoded_bin = nullptr) {
  const int samples = table.samples();
  const Eigen::MatrixXd points = reference_points(camera, table);
  double sum = 0.0;
  for (std::size_t t = 0; t < batch.trials.size(); ++t) {
    const double position = batch.trials[t].depth_periods * samples;
    const Eigen::VectorXd y = reference_electrons(camera, table, point, batch, t);
    double best = -1.0, best_bin_score = -1e300, total = 0.0, weighted = 0.0;
    Eigen::VectorXd score(samples), error(samples), place_of(samples);
    int best_bin = 0;
    for (int j = 0; j < samples; ++j) {
      const Eigen::VectorXd p0 = points.col(j), p1 = points.col((j + 1) % samples);
      const double b0 = y.dot(p0), b1 = y.dot(p1);
      const double q00 = p0.dot(p0) + 1e-10, q01 = p0.dot(p1), q11 = p1.dot(p1) + 1e-10;
      const double u = q11 * b0 - q01 * b1, v = q00 * b1 - q01 * b0;
      double place = b1 * std::abs(b1) * q00 > b0 * std::abs(b0) * q11 ? 1.0 : 0.0;
      if (u > 0 && v > 0) place = v / (u + v);
      const double match = std::max(0.0, (1 - place) * b0 + place * b1);
      const double square =
          std::max(1e-10, q00 * (1 - place) * (1 - place) + 2 * q01 * place * (1 - place) +
                              q11 * place * place);
      score[j] = 0.5 * match * match / square;
      error[j] = std::abs(j + place - position);
      if (circular) error[j] = std::min(error[j], samples - error[j]);
      best = std::max(best, score[j]);
      place_of[j] = place;
      if (b0 * std::abs(b0) / q00 > best_bin_score) {
        best_bin_score = b0 * std::abs(b0) / q00;
        best_bin = j;
      }
    }
    const int left = (best_bin + samples - 1) % samples;
    const int chord = score[left] > score[best_bin] ? left : best_bin;
    if (decoded_bin) *decoded_bin = chord + place_of[chord];
    for (int j = 0; j < samples; ++j) {
      const double share = std::exp(sharpness * (score[j] - best));
      total += share;
      weighted += share * error[j];
    }
    sum += batch.trials[t].weight * weighted / total;
  }
  return sum / static_cast<double>(batch.trials.size());
}

/// The same error when trials are decoded as two returns, over all pairs of the grid.
inline double reference_two_return_error(const SampledCamera& camera, const MeasurementTable& table,
                                         const OperatingPoint& point, const TrialBatch& batch,
                                         double sharpness, double* decoded_bin = nullptr) {
  const int samples = table.samples();
  const TwoReturnGrid grid = *batch.two_returns;
  const int step = samples / grid.bins;
  const Eigen::MatrixXd points = reference_points(camera, table);
  double sum = 0.0;
  for (std::size_t t = 0; t < batch.trials.size(); ++t) {
    const Eigen::VectorXd y = reference_electrons(camera, table, point, batch, t);
    std::vector<double> score, error;
    for (int j = 0; j < samples; j += step)
      for (int delay = grid.delays.shortest; delay <= grid.delays.longest; ++delay) {
        Eigen::MatrixXd pair(y.size(), 2);
        pair << points.col(j), points.col((j + delay * step) % samples);
        const Eigen::Vector2d match = pair.transpose() * y;
        const Eigen::Matrix2d gram = pair.transpose() * pair;
        Eigen::Vector2d strength = gram.inverse() * match;
        if (strength[1] < 0.0 || strength[0] < strength[1]) {
          const Eigen::Vector2d alone(std::max(0.0, match[0]) / gram(0, 0), 0.0);
          const Eigen::Vector2d equal =
              Eigen::Vector2d::Constant(std::max(0.0, match.sum()) / gram.sum());
          strength = match.dot(equal) > match.dot(alone) ? equal : alone;
        }
        score.push_back(0.5 * y.squaredNorm() - 0.5 * (y - pair * strength).squaredNorm());
        const double off = std::abs(j - batch.trials[t].depth_periods * samples);
        error.push_back(std::min(off, samples - off));
        if (decoded_bin && score.back() >= *std::max_element(score.begin(), score.end()))
          *decoded_bin = j;
      }
    const double best = *std::max_element(score.begin(), score.end());
    double total = 0.0, weighted = 0.0;
    for (std::size_t k = 0; k < score.size(); ++k) {
      const double share = std::exp(sharpness * (score[k] - best));
      total += share;
      weighted += share * error[k];
    }
    sum += weighted / total;
  }
  return sum / static_cast<double>(batch.trials.size());
}

}  // namespace tofsmith
