// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "decode/expected_noise.hpp"
#include "decode/likelihood/correlated_noise.hpp"
#include "decode/multipath/shared/bounded_quadratic.hpp"
#include "decode/output/pixel_model.hpp"

namespace tofsmith {

/// Measurements of one pixel, as the likelihood takes them.
struct LikelihoodPixel {
  const double* electrons = nullptr;  ///< without dark (K)
  double min_variance_e2 = 0.0;       ///< smaller expected variances count as this
  double variance_share = 1.0;        ///< of the noise of a single measurement
};

/// The most likely light on the chord from bin `bin` to the next: mean and variance of every
/// measurement are linear in light(at bin, at the next bin, ambient), which are all >= 0.
struct ChordFit {
  std::int32_t bin = 0;
  Quadratic::Vector light{};  ///< signal seen at both ends of the chord, ambient [e/s]
  double cost = 0.0;          ///< sum_i (y_i - mu_i)^2 / v_i + log v_i

  double signal_e_per_s() const { return light[0] + light[1]; }
  Position position() const {
    const double signal = signal_e_per_s();
    return {bin, signal > 0.0 ? light[1] / signal : 0.0};
  }
  bool is_at_bin() const { return light[1] == 0.0; }
  bool is_at_next() const { return light[0] == 0.0 && light[1] > 0.0; }
};

/// The likelihood of depth, signal and ambient light on the chords between bins. Measurements of
/// correlated noise come whitened, with the covariance that is left of it: then all of
///   cost = (y - mu)^T C^-1 (y - mu) + log det C
/// counts, with C linear in light as the variances are, and held up on its diagonal as they are.
class LikelihoodModel {
 public:
  /// @param table  whitened(), where measurements are rows
  LikelihoodModel(const DecodingTable& table, const AmbientProjection& projection);

  /// The least variance taken for a pixel: electrons are whole, so that little light seen where
  /// much is seen elsewhere does not mean none.
  LikelihoodPixel pixel(const double* electrons, double variance_share = 1.0) const;

  /// Twice the negative log-likelihood of some light on a chord, up to a constant.
  double cost(const LikelihoodPixel& pixel, std::int32_t bin, const Quadratic::Vector& light) const;

  /// Least weighted squares on a chord: sum_i weight_i (y_i - mu_i)^2 - weight_i y_i^2, halved.
  BoundedMinimum least_squares(const LikelihoodPixel& pixel, std::int32_t bin,
                               const double* weight) const;
  /// The least cost on a chord, by Fisher scoring from the least squares of these weights on.
  ChordFit fit(const LikelihoodPixel& pixel, std::int32_t bin, const double* weight) const;
  /// The least cost around a bin: on both chords beside it, and on from there while it falls.
  ChordFit fit_around(const LikelihoodPixel& pixel, std::int32_t bin, const double* weight) const;
  /// The least cost on the chords up to three bins from a fit: the bends between chords leave
  /// several least points in one lobe.
  ChordFit fit_near(const LikelihoodPixel& pixel, const ChordFit& found,
                    const double* weight) const;

  /// Light at a fit, and deviations by the Fisher information that means alone hold.
  PixelEstimate estimate(const LikelihoodPixel& pixel, const ChordFit& fit) const;

 private:
  std::int32_t next(std::int32_t bin) const { return bin + 1 < samples_ ? bin + 1 : 0; }
  std::int32_t previous(std::int32_t bin) const { return bin > 0 ? bin - 1 : samples_ - 1; }
  Quadratic scoring(const LikelihoodPixel& pixel, std::int32_t bin,
                    const Quadratic::Vector& light) const;
  double correlated_cost(const LikelihoodPixel& pixel, std::int32_t bin,
                         const Quadratic::Vector& light) const;
  Quadratic correlated_scoring(const LikelihoodPixel& pixel, std::int32_t bin,
                               const Quadratic::Vector& light) const;

  int samples_, measurements_;
  int unknowns_;  // 2 where ambient light cannot be seen, else 3
  Eigen::VectorXd ambient_;
  RowMajorMatrix gated_;  // x = T o chi (N, K)
  ExpectedNoise noise_;
  std::optional<CorrelatedNoise> correlated_;  // none: measurements are independent
};

}  // namespace tofsmith
