// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// Depth of a surface, extrapolated to the pixel.
struct SurfaceDepth {
  double depth_m = 0.0;
  double deviation_m = 0.0;
};

/// Decides whether one or two returns of known depths explain a pixel.
class MixedPixelFit {
 public:
  explicit MixedPixelFit(const DecodingTable& table);

  int rank() const { return rank_; }
  int measurements() const { return measurements_; }

  struct Explanation {
    bool is_two = false;        ///< both returns are positive, and better than one surface alone
    bool is_no_single = false;  ///< is_two, and better than a single return at the decoded depth
    double first_e_per_s = 0.0, second_e_per_s = 0.0;
    double chi2 = 0.0;  ///< of the fit with both
  };

  /// @param electrons  without dark electrons (K)
  /// @param decoded_m  depth of a single return; NaN if unknown
  Explanation explain(const double* electrons, double averaged, double decoded_m,
                      const SurfaceDepth& first, const SurfaceDepth& second) const;

 private:
  using Measured = std::array<double, max_measurements>;
  struct Return {
    Measured light, per_m, shot;
  };
  struct Fit {
    Eigen::Vector3d amount;  ///< of the returns, then ambient light
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
