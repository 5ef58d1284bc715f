// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "decode/ambient_projection.hpp"
#include "decode/expected_noise.hpp"

namespace tofsmith {

/// A surface near a pixel, as it would be seen there.
struct SurfaceDepth {
  double depth_m = 0.0;
  double deviation_m = 0.0;  ///< standard deviation of it
};

/// Decides between one return and two of known depths.
class MixedPixelFit {
 public:
  explicit MixedPixelFit(const DecodingTable& table);

  int rank() const { return rank_; }
  int measurements() const { return measurements_; }

  /// What the measurements of a pixel are explained by.
  struct Explanation {
    bool is_two = false;        ///< both returns are there, and better than one of them alone
    bool is_no_single = false;  ///< and better than a single return at the decoded depth
    double first_e_per_s = 0.0, second_e_per_s = 0.0;  ///< of both surfaces
    double chi2 = 0.0;                                 ///< of both
  };

  /// @param electrons  without dark ones (K)
  /// @param averaged   of how many measurements they are the mean
  /// @param decoded_m  depth that a single return would have; NaN: not known
  Explanation explain(const double* electrons, double averaged, double decoded_m,
                      const SurfaceDepth& first, const SurfaceDepth& second) const;

 private:
  using Measured = std::array<double, max_measurements>;
  struct Return {
    Measured light, per_m, shot;
  };
  struct Fit {
    Eigen::Vector3d amount;  ///< of the returns, then of ambient light
    double chi2 = 0.0;
  };

  Return return_at(double depth_m) const;
  template <int Returns>
  Fit fit(const double* electrons, const Measured& weight,
          const std::array<const Return*, Returns>& returns) const;

  int measurements_, samples_, rank_;
  double range_m_;
  bool has_ambient_;
  RowMajorMatrix gated_;
  Eigen::VectorXd ambient_;
  ExpectedNoise noise_;
};

}  // namespace tofsmith
