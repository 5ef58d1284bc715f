// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstddef>
#include <new>
#include <vector>

#include "core/shared/periodic.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Waveforms constant within N cells of a grid.
struct SampledCode {
  Eigen::MatrixXd modulation;    ///< (N, E)
  Eigen::MatrixXd demodulation;  ///< (N, E x taps)
  Eigen::VectorXd shares = {};   ///< of the integration time (E); empty: the camera's times

  int samples() const { return static_cast<int>(modulation.rows()); }
};

/// False for differences of buckets at duty 1/2, unless their sensitivities differ by more than
/// unknown_ambient_gain() ignores.
bool sees_ambient(const Camera& camera, int exposures);

/// Integration times of the measurements and the variance that does not depend on light.
struct MeasurementTimes {
  Eigen::VectorXd exposure_s;            ///< (R)
  Eigen::VectorXd constant_variance_e2;  ///< of read noise, quantization and dark current (R)
};

/// Correlation functions of waveforms on a grid, and gradients w.r.t. the waveforms. Includes band
/// limits, contrast, mismatch and readout of taps.
class SampledCamera {
 public:
  struct Measured {
    MeasurementTable table;
    MeasurementTimes times;
    std::vector<Eigen::VectorXcd> modulation, demodulation;
    std::vector<Eigen::VectorXcd> square;  ///< of squared weights, if needed
    Eigen::MatrixXd weight;                ///< of a mixer (N, E)
  };

  /// A mixer is two buckets (in_buckets()) whose difference is its weight. If weights need not be
  /// binary, its shot noise depends on their square.
  SampledCamera(const Camera& camera, int samples, int exposures);

  int samples() const { return transform_.samples(); }
  int measurements() const { return static_cast<int>(combination_.rows()); }
  /// Integration times [s] (R).
  const Eigen::VectorXd& exposure_s() const { return times_.exposure_s; }
  /// Read noise, quantization and dark current [e^2] (R).
  const Eigen::VectorXd& constant_variance_e2() const { return times_.constant_variance_e2; }
  const MeasurementTimes& times() const { return times_; }
  /// Times for shares of the total integration time (E).
  MeasurementTimes times(const Eigen::VectorXd& shares) const;
  /// Converts a gradient w.r.t. exposure_s (R) to one w.r.t. the shares (E).
  Eigen::VectorXd pull_back_times(const Eigen::VectorXd& by_exposure_s) const;
  /// Variance of dark current per second of integration [e^2/s] (R).
  Eigen::VectorXd dark_variance_e2_per_s() const { return dark_e_per_s_ * taps_read_; }
  /// Electrons of dark current (R).
  const Eigen::VectorXd& dark_electrons() const { return dark_electrons_; }
  /// True if buckets are subtracted; shot noise comes from their sum.
  bool subtracts() const { return difference_; }
  bool ambient_unknown() const { return ambient_unknown_; }

  /// Gain of harmonic n in [0, N/2] through both arms.
  std::complex<double> transfer(int harmonic) const {
    return transfer_[harmonic] * static_cast<double>(samples());
  }

  Measured measure(const SampledCode& code) const;
  /// Omits the table, which pull_back() does not need. Not for mixers.
  Measured transformed(const SampledCode& code) const;

  SampledCode pull_back(const Measured& measured, const MeasurementTable& gradient) const;

 private:
  SampledCamera(const Camera& camera, int samples, int exposures, bool squares);
  void measure_squares(const SampledCode& code, Measured& measured) const;
  MeasurementTimes times_for(Eigen::VectorXd exposure_s) const;

  PeriodicTransform transform_;
  int exposures_, taps_;
  bool difference_, ambient_unknown_;
  bool squares_;
  Eigen::VectorXcd transfer_;    // G / N
  Eigen::MatrixXd combination_;  // (R, all taps): contrast, mismatch, readout
  Eigen::MatrixXd shot_combination_;
  double total_s_, dark_e_per_s_, read_variance_e2_;
  Eigen::VectorXd taps_read_;  // number of taps that contribute to each measurement
  MeasurementTimes times_;
  Eigen::VectorXd dark_electrons_;
};

MeasurementTable zeros_like(const MeasurementTable& table);

/// For aligned vector loads.
template <typename Value>
struct CacheLineAllocator {
  using value_type = Value;
  static constexpr std::align_val_t alignment{64};

  CacheLineAllocator() = default;
  template <typename Other>
  explicit CacheLineAllocator(const CacheLineAllocator<Other>&) {}

  Value* allocate(std::size_t count) {
    return static_cast<Value*>(::operator new(count * sizeof(Value), alignment));
  }
  void deallocate(Value* values, std::size_t) { ::operator delete(values, alignment); }
  friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
};

template <typename Value>
using Aligned = std::vector<Value, CacheLineAllocator<Value>>;
using AlignedFloats = Aligned<float>;

/// |p|^2 of a point without contrast.
template <typename Value>
inline constexpr Value smallest_square = Value(1e-10f);

/// Curve that the decoder matches, with the ambient component projected out:
///   p_j = P x_j,  x_j = g o chi_j,  P = I - a a^T / |a|^2,  a = g o kappa,  g_i = T_i / mean T,
/// at bins j in [0, N], where bin N equals bin 0; and Q_jk = <p_j, p_k> for adjacent bins.
/// @tparam Value  float, or double to compare gradients with finite differences
template <typename Value>
struct DecodingCurveOf {
  DecodingCurveOf(const SampledCamera& camera, const MeasurementTable& table)
      : DecodingCurveOf(camera, table, camera.exposure_s()) {}
  DecodingCurveOf(const SampledCamera& camera, const MeasurementTable& table,
                  const Eigen::VectorXd& exposure_s);

  const Value* component(int r) const { return points.data() + r * stride; }

  int samples, measurements;
  int stride;                      ///< between components: whole vectors, plus one
  Aligned<Value> points;           ///< (R, stride)
  Aligned<Value> squares;          ///< Q_jj, j in [0, N]
  Aligned<Value> products;         ///< Q_j,j+1, j in [0, N)
  Aligned<Value> inverse_lengths;  ///< 1 / sqrt(Q_jj + smallest_square), j in [0, N]
  Eigen::MatrixXd exact_points;    ///< (N, R)
  Eigen::VectorXd exposure_s;      ///< T (R)
};
using DecodingCurve = DecodingCurveOf<float>;

template <typename Value>
struct CurveGradientOf {
  explicit CurveGradientOf(const DecodingCurveOf<Value>& curve);
  /// Adds to `gradient` and, unless null, to the gradient w.r.t. the integration times (R).
  void pull_back(const SampledCamera& camera, const MeasurementTable& table,
                 const DecodingCurveOf<Value>& curve, MeasurementTable& gradient,
                 Eigen::VectorXd* by_exposure_s = nullptr) const;

  Aligned<Value> points;                 ///< (R, stride)
  Aligned<Value> squares, next_squares;  ///< w.r.t. Q_jj and Q_j+1,j+1, through chord j
  Aligned<Value> products;
};
using CurveGradient = CurveGradientOf<float>;

}  // namespace tofsmith
