// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/design/candidate.hpp"

namespace tofsmith {

/// Options of the direct optimization of codes for depth error.
struct OptimizeOptions {
  int samples = 120;            ///< cells per period while optimizing, 24 .. 960; fewer where the
                                ///< camera's shortest pulse is longer than such a cell
  int starts = 20;              ///< descents from different codes, >= 1
  int steps_per_start = 300;    ///< >= 1
  int hops = 40;                ///< descents from changed copies of the best, >= 0
  int steps_per_hop = 300;      ///< >= 1
  int patience = 30;            ///< end hopping after so many hops without a better code; 0: never
  int refined = 1;              ///< how many of the best codes are refined, >= 1
  int refinement_steps = 1000;  ///< per refined code, >= 0
  int trials_per_step = 200;    ///< noisy measurements per gradient, over all light levels, >= 8
  int pool_trials = 20000;      ///< over all light levels, to rank codes while searching, >= 1000
  bool polish = true;           ///< move the switching times of the result continuously
  int polish_steps = 250;       ///< >= 0
  std::uint64_t seed = 1;
  /// On cameras with operating.multipath and enough measurements: weight of log E3 in the loss,
  /// beside log E1^(1 - w) E2^w of OperatingMultipath::weight, with E3 the error of the direct
  /// depth where pairs of returns are looked for on the bins of a grid. It keeps pairs from looking
  /// like others, so that two returns can be decoded; >= 0.
  double two_return_weight = 0.02;
  /// On cameras with operating.multipath: two-return decoding of a code may err this many times as
  /// much as it does of the best baseline that can be decoded so, if there is one; what errs more
  /// counts to the judge as so many times worse, up to 1.25 times; >= 1.
  double max_two_return_loss = 3.0;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<OptimizeOptions> auto& o) {
  return std::tuple(
      Field("samples", o.samples, "in [24, 960]"), Field("starts", o.starts, ">= 1", ByEffort{2}),
      Field("steps_per_start", o.steps_per_start, ">= 1"),
      Field("hops", o.hops, ">= 0", ByEffort{0}), Field("steps_per_hop", o.steps_per_hop, ">= 1"),
      Field("patience", o.patience, ">= 0"), Field("refined", o.refined, ">= 1"),
      Field("refinement_steps", o.refinement_steps, ">= 0", ByEffort{50}),
      Field("trials_per_step", o.trials_per_step, ">= 8"),
      Field("pool_trials", o.pool_trials, ">= 1000"), Field("polish", o.polish),
      Field("polish_steps", o.polish_steps, ">= 0"), Field("seed", o.seed, FieldMark::from_above),
      Field("two_return_weight", o.two_return_weight, "finite and >= 0"),
      Field("max_two_return_loss", o.max_two_return_loss, ">= 1"));
}

/// Optimizes all pairs of modulation and demodulation together for the depth error of a camera:
/// geometric mean over its operating points, linear or circular as the camera asks.
///
/// Waveforms go downhill along stochastic gradients through band limit, correlation, noise and a
/// soft decoder, from a pool of starts (all families, random codes and the codes given);
/// the best are changed and go downhill again; the best of all are refined, made to switch where
/// arms are binary, and their edges polished. Light may use less than its peak. Taps: one; two
/// buckets that share all charge; more, exclusive, with a drain where the camera has one; a mixer.
/// Every pulse and gap of binary waveforms is at least sensor.shortest_pulse_s long.
///
/// Where an arm need not switch the whole search is made for arms that do, too, and then begins
/// with what it found. From twice the default effort on (with_effort()) a search begins with all of
/// that of half the effort. Candidates of both join: what contains more never loses by it.
/// @param exposures  1 .. 8, with at least 3 measurements in all (2 differences)
/// @param also  codes that join the starts, where they have as many exposures
/// @return codes that the camera can play, each named "optimized-k<exposures>", those first that
/// the
///         search likes better: the best of the pool with switching times on the grid, then with
///         polished edges; those of arms that switch and of less effort before. They are not
///         judged: Candidate::error is empty, and which one is best, at which origin, and whether
///         it beats the codes given, is for judge() of design/design.hpp, with random numbers that
///         nothing was chosen by. design() does both.
/// @throws std::invalid_argument for bad options, an invalid camera, too few measurements, a camera
///         without band limit and without sensor.shortest_pulse_s; Interrupted
/// @note same bits for any number of threads
std::vector<Candidate> optimize(const Camera& camera, int exposures,
                                const OptimizeOptions& options = {},
                                std::span<const CodeSet> also = {}, const Progress& progress = {});

/// The same for the worst of several variants of a camera, the first of which is the camera itself:
/// the code must be one that it can play. Taps and readout of all must be the same.
std::vector<Candidate> optimize(std::span<const Camera> variants, int exposures,
                                const OptimizeOptions& options = {},
                                std::span<const CodeSet> also = {}, const Progress& progress = {});

/// A shortest pulse that the camera's samples can follow [s]: two of them.
double suggested_shortest_pulse_s(const Camera& camera);

/// Light that P pixels see.
struct PixelLight {
  std::span<const double> depth_bin, signal_e_per_s, ambient_e_per_s;  ///< (P) each
};

/// Gradient of a function of the measurements of pixels.
struct PixelGradient {
  MeasurementTable table;                                      ///< by the code's table
  Eigen::VectorXd depth_bin, signal_e_per_s, ambient_e_per_s;  ///< (P)
};

/// By what gradients are wanted.
struct WantedGradients {
  bool table = true;
  bool light = true;  ///< signal and ambient
  bool depth = true;
};

/// Gradient of a function of decoded depths.
template <typename Value>
struct DecodedGradient {
  MeasurementTable table;
  std::vector<Value> electrons;  ///< (P, K)
};

/// How measurements are decoded softly: chord j between bins is chosen with probability
///   exp(S_j / temperature_e2) / sum,  S_j = 1/2 max(<y, p>, 0)^2 / |p|^2 at the best point p of
///   it,
/// on the correlation functions without what ambient light explains.
struct SoftDecoding {
  std::span<const double> temperature_e2;  ///< (P), > 0; the variance of y is what noise suggests
  bool circular = false;                   ///< depths and errors go the shorter way round
};

/// What optimize() goes downhill along, for others to learn codes with: from waveforms that are
/// held over N cells to tables, electrons, soft decoding and the Cramer-Rao bound, each step with
/// its adjoint. Waveforms may be any real numbers, whether a camera can play them or not. Arms,
/// contrast, readout of taps, dark current and exposures are the camera's. Variances are those
/// before any clipping.
/// @note thread-safe; same bits for any number of threads
class CodeGradients {
 public:
  /// Matrices of pixels, one row each.
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// @throws std::invalid_argument if the camera is invalid, or has rows, a generator, playback,
  ///         temperature or tap_mismatch, which waveforms would have to be known for
  CodeGradients(const Camera& camera, int samples, int exposures);
  ~CodeGradients();
  CodeGradients(const CodeGradients&) = delete;
  CodeGradients& operator=(const CodeGradients&) = delete;

  int samples() const;
  int exposures() const;
  int tap_values() const;    ///< columns of a demodulation, exposures x taps
  int measurements() const;  ///< K: what leaves the sensor
  bool has_shot() const;     ///< whether tables have the light behind differences too

  /// Correlation functions of waveforms (N, E) and (N, E x taps) at the bins.
  MeasurementTable measure(const Eigen::MatrixXd& modulation,
                           const Eigen::MatrixXd& demodulation) const;
  /// Gradient by {modulation, demodulation} of a function whose gradient by the table is given.
  std::pair<Eigen::MatrixXd, Eigen::MatrixXd> pull_back(const Eigen::MatrixXd& modulation,
                                                        const Eigen::MatrixXd& demodulation,
                                                        const MeasurementTable& by_table) const;

  /// Expected electrons [e] and variance [e^2] of the measurements (P, K), as of ForwardModel.
  void electrons(const MeasurementTable& table, const PixelLight& light, Rows& mean,
                 Rows& variance) const;
  /// @param by_mean, by_variance  (P, K)
  /// @param wanted  others are zero
  PixelGradient pull_back_electrons(const MeasurementTable& table, const PixelLight& light,
                                    const Rows& by_mean, const Rows& by_variance,
                                    WantedGradients wanted = {}) const;

  /// Expected depth [bin] (P) of electrons (P, K) with dark current taken off. Circular: the mean
  /// about the best match, on the shorter way round, in [0, N).
  template <typename Value>
  std::vector<double> soft_decode(const MeasurementTable& table, std::span<const Value> electrons,
                                  const SoftDecoding& decoding) const;
  /// Expected |error| [bin] (P), of depths that are true.
  template <typename Value>
  std::vector<double> soft_error(const MeasurementTable& table, std::span<const Value> electrons,
                                 const SoftDecoding& decoding,
                                 std::span<const double> true_bin) const;
  /// Gradient of sum weight[p] of soft_decode(), or where true_bin is not empty of soft_error().
  /// That by a temperature is -<y, gradient by y> / (2 temperature): S is quadratic in y.
  template <typename Value>
  DecodedGradient<Value> pull_back_decoded(const MeasurementTable& table,
                                           std::span<const Value> electrons,
                                           const SoftDecoding& decoding,
                                           std::span<const double> true_bin,
                                           std::span<const double> weight) const;

  /// CramerRaoBound::sigma_m() of a table with 4 cells per bin [m] (4 N, points).
  Eigen::MatrixXd depth_deviation_m(const MeasurementTable& table,
                                    std::span<const OperatingPoint> points) const;
  /// Gradient of sum by_deviation o depth_deviation_m(): by the table, and signal_e_per_s and
  /// ambient_e_per_s (points). Infinite deviations count nothing.
  PixelGradient pull_back_depth_deviation(const MeasurementTable& table,
                                          std::span<const OperatingPoint> points,
                                          const Eigen::MatrixXd& by_deviation) const;

  /// Electrons of dark current (K), which decoding takes off.
  const Eigen::VectorXd& dark_electrons() const;

  struct Steps;  ///< what they stand on

 private:
  std::unique_ptr<const Steps> steps_;
};

}  // namespace tofsmith
