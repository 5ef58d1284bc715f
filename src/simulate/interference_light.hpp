// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/shared/random.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Light of one other camera in the tap values of a code, relative to the mean rate of this light
/// at a sensor that is always open. It depends on the phase u of the other camera [periods]:
///   y_i(u) = D_i0 M_0 + 2 Re sum_m D_in conj(M_m) sinc(d T) exp(2 pi i (m u - d t)),
///   d = m f' - n f0,
/// with the harmonics M of the modulation, the harmonic n of the demodulation D that is nearest in
/// frequency to m f', and the duration T and middle t of the exposure. Spreading replaces T by the
/// duration of a part and averages over the parts.
class InterferenceLight {
 public:
  /// Row j is the light at u = j / phases; averages of products of two harmonics are exact.
  using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  static constexpr int phases = 2048;

  /// @param camera  with operating.interference
  /// @throws InvalidArgument if the other cameras do not support their code
  InterferenceLight(const CodeSet& code, const Camera& camera);

  /// Exposures of the other camera that the first exposure may see.
  int starts() const { return static_cast<int>(whole_.size()); }
  /// Light with the same phase in all parts, (phases, tap values).
  const Table& whole(int start) const { return whole_[static_cast<std::size_t>(start)]; }
  /// Light in one part that spreading changes; empty without spreading.
  const Table& part(int start) const { return part_[static_cast<std::size_t>(start)]; }
  /// Mean modulation of the other camera.
  double mean() const { return mean_; }

  /// Returns the mean of y y^T, where y = `measuring` * (tap values), over phases and starts.
  /// @param measuring  (K, tap values)
  Eigen::MatrixXd second_moment(const Eigen::MatrixXd& measuring) const;
  /// Returns the mean of y.
  Eigen::VectorXd first_moment(const Eigen::MatrixXd& measuring) const;

  /// Adds the light in one frame with random start, phase and spreading.
  void add(double signal_e_per_s, RandomStream& random, std::vector<double>& light) const;

 private:
  OperatingInterference interference_;
  Eigen::Index exposures_ = 1;
  double mean_ = 0.0;
  std::vector<Table> whole_, part_;
};

}  // namespace tofsmith
