// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "decode/ambient_projection.hpp"
#include "tofsmith/decode/range_part.hpp"

namespace tofsmith {

/// Scalar products in the decoding subspace, <u, w>_C = u^T C^-1 w, with the covariance C = V^T
/// diag(v) V of q. Allocates nothing.
class NoiseMetric {
 public:
  static constexpr std::size_t max_pairs =
      static_cast<std::size_t>(max_measurements) * (max_measurements + 1) / 2;

  /// @param noise_basis  V (K, rank)
  /// @param plane        q (rank)
  /// @param variance_e2  v (K)
  NoiseMetric(const RowMajorMatrix& noise_basis, const double* plane, const double* variance_e2);

  /// Lower triangle, row by row.
  const double* metric() const { return metric_.data(); }
  /// C^-1 q (rank).
  const double* along() const { return along_.data(); }
  /// |q|_C.
  double length() const { return length_; }
  /// Returns an upper bound on the factor by which small angles grow; infinite if the noise is too
  /// uneven.
  double stretch() const;

  double product(const double* u, const double* w) const;
  /// <q, u>_C.
  double signal(const double* u) const;

 private:
  int rank_;
  std::array<double, max_pairs> metric_;
  std::array<double, max_measurements> along_;
  double length_ = 0.0;
};

/// Posterior probability of positions on the chords between bins, inside and outside a main lobe.
/// On a chord the signal in standard deviations is c = rho cos(theta - theta_0); for strong signals
/// the density exp(c^2 / 2) sqrt(2 pi) / c is nearly a Gaussian of standard deviation 1 / rho.
class ChordMass {
 public:
  /// Adds a chord of one bin, unless its probability is below exp(-40) of the total.
  /// @param from, to  c at both ends
  /// @param cosine    of the angle between both ends
  void add_chord(double from, double to, double cosine, bool is_inside);
  /// Adds half a bin at each of two unconnected bins.
  void add_ends(double from, double to, bool is_inside);

  double share_inside() const;

 private:
  /// Adds factor exp(c^2 / 2).
  void add(double c, double factor, bool is_inside);

  double peak_ = 0.0;  // reference c^2 / 2 of all sums
  double inside_ = 0.0;
  double outside_ = 0.0;
};

/// Maximum half width of the main lobe as a share of the range.
inline constexpr double max_lobe_share = 0.05;

/// Extent of the main lobe before and after a row [rows].
struct MainLobe {
  double left = 0.0;
  double right = 0.0;
};

/// Test that proves a confidence of 1. With c = <q, u_b> for the direction u_b of the row, other
/// places score at most
///   cosine c + sine sqrt(|q|^2 - c^2)
/// up to the margins in LobePosterior::bound().
struct LobeBound {
  double cosine = 1.0;
  double sine = 0.0;
};

/// Lead in chi-square that proves a confidence of 1: the probability of other places is at most
/// about 1e-3.
inline constexpr float sure_lead = 14.0f;

/// Variance of components of q = V^T y' with covariance C = V^T diag(v) V: mean plus half the
/// standard deviation of the eigenvalues of C.
double typical_variance(const Eigen::MatrixXd& noise_basis, const Eigen::VectorXd& variance);

/// Nodes per block. Sums have the same bits for all lengths of vectors.
inline constexpr int nodes_per_block = 16;

/// Posterior probability that the depth lies in the main lobe around a row. A priori, all depths
/// are equally likely, ambient light may have any value, and the density of the signal is
/// proportional to 1/S from a tenth of its standard deviation upwards. For Gaussian noise of
/// covariance C and c(z) = <q, p(z)>_C / |p(z)|_C, the signal in standard deviations,
///   p(z) = integral from 0.1 to infinity of exp(c t - t^2 / 2) / t dt.
///
/// The main lobe ends where the score of the row's own measurements stops decreasing, at most 5 %
/// of the range away. Smooth curves are interpolated, because lobes may be narrow; `places` are the
/// interpolated rows.
class LobePosterior {
 public:
  LobePosterior(const DecodingTable& table, const AmbientProjection& projection);

  MainLobe main_lobe(std::int32_t row) const;
  const LobeBound& bound(std::int32_t row) const { return bounds_[static_cast<std::size_t>(row)]; }

  /// Returns true if the lead of the best score near the row proves a confidence of 1, often where
  /// LobeBound does not.
  /// @param plane          q (rank)
  /// @param score          <q, u_b> of the row
  /// @param least_lead_e2  sure_lead times the variance
  bool is_sure(const float* plane, float score, float least_lead_e2, std::int32_t row) const;

  /// @param plane        q (rank)
  /// @param variance_e2  of every measurement (K)
  /// @return in [0, 1], the same bits on every processor
  /// @note thread-safe; rarely allocates memory
  double probability(const double* plane, const double* variance_e2, std::int32_t row) const;
  /// Returns probability(), or 1 if LobeBound or is_sure() proves it. Depths outside of `part` are
  /// less likely a priori by the factor `outside_prior`; returns none if the depth still lies
  /// outside with a probability of at least 0.9.
  /// @param part  of the range; null: all of it
  std::optional<double> confidence(const double* plane, const double* variance_e2, std::int32_t row,
                                   const RangePart* part) const;
  static constexpr double outside_prior = 0.01;

  /// Points of the curve at most `step` radians apart.
  struct Nodes {
    double step = 0.0;
    int count = 0;
    int stride = 0;                ///< count in whole blocks
    std::vector<float> direction;  ///< unit vectors (rank, stride); 0 without contrast
    std::vector<float> centre;     ///< of the part that a node represents [place]
    std::vector<float> width;      ///< of that part [place]; 0 in the padding
  };

 private:
  static constexpr double sparse_step_rad = 0.24, coarse_step_rad = 0.08, fine_step_rad = 0.02;
  Nodes make_nodes(double step) const;
  struct Lobe {
    std::int32_t left = 0;
    std::int32_t right = 0;
  };
  struct Window {
    std::int32_t begin = 0;
    std::int32_t length = 0;
  };
  Window lobe_window(std::int32_t row) const;
  Window window_of(const RangePart& part) const;
  Window lobe_within(std::int32_t row, const Window& allowed) const;
  double half_way(double from, double to) const;
  const Lobe& lobe(std::int32_t row) const { return lobes_[static_cast<std::size_t>(row)]; }
  float score_beside(const float* plane, float score, std::int32_t row) const;
  void find_lobes();
  void find_bounds();
  void find_bounds(std::int32_t begin, std::int32_t end, Eigen::RowVectorXf& score);
  bool is_certain(const double* plane, const double* variance_e2, std::int32_t row) const;
  double share_of(const Window& window, const NoiseMetric& noise) const;
  double sum_over_nodes(const Nodes& nodes, const NoiseMetric& noise, const Window& window) const;
  double sum_over_chords(const NoiseMetric& noise, const Window& window) const;

  std::int32_t rows_;
  int rank_;
  int places_per_row_;
  std::int32_t places_;
  RowMajorMatrix curve_;        // p (places, rank)
  RowMajorMatrix unit_;         // p / |p|; 0 without contrast
  RowMajorMatrix noise_basis_;  // V (K, rank)
  Eigen::VectorXd turn_rad_;    // to the next place; infinite without chord
  std::vector<Lobe> lobes_;     // of rows
  std::vector<LobeBound> bounds_;
  Nodes sparse_, coarse_, fine_;
};

}  // namespace tofsmith
