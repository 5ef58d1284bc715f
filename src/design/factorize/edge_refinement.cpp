// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/factorize/edge_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/NonLinearOptimization>
#include <utility>
#include <vector>

#include "design/run_lengths.hpp"

namespace tofsmith {

namespace {

constexpr int delays_per_point = 4;
constexpr int max_settling_rounds = 8;
constexpr int fine_points = 4;  // per bin; finer grids are not rounded

/// Points per period of a generator; 0 if rounding is negligible.
int coarse_points(const std::optional<Generator>& generator, const PairModel& model) {
  if (!generator) return 0;
  const int points = generator->points_per_period(model.camera().fundamental_frequency_hz);
  return points < fine_points * model.samples() ? points : 0;
}

struct RoundedArm {
  Waveform waveform;
  std::vector<char> on = {};  ///< empty: not rounded
  double most_level = 1.0;    ///< maximum of 1 / duty for light; 1 for gates

  RoundedArm(const Waveform& nominal, int points, double most_level_)
      : waveform(nominal), most_level(most_level_) {
    if (points == 0) return;
    const Eigen::VectorXd shares =
        Waveform::binary(nominal.on_intervals(), 1.0).cell_averages(points);
    for (const double share : shares) on.push_back(share > 0.5);
    render();
  }

  std::ptrdiff_t points_on() const { return std::count(on.begin(), on.end(), 1); }

  bool is_playable() const {
    const auto count = points_on();
    return count > 0 && count < std::ssize(on) &&
           (most_level == 1.0 || static_cast<double>(std::ssize(on)) <=
                                     most_level * (1 + 1e-9) * static_cast<double>(count));
  }

  void render() {
    if (!is_playable()) return;
    const auto points = static_cast<double>(on.size());
    const std::size_t first =
        static_cast<std::size_t>(std::find(on.begin(), on.end(), 0) - on.begin());
    std::vector<OnInterval> intervals;
    for (std::size_t i = 1; i <= on.size(); ++i) {  // once around, starting at an off point
      const std::size_t at = (first + i) % on.size();
      const bool was_on = on[(first + i - 1) % on.size()] != 0;
      if (on[at] != 0 && !was_on) intervals.push_back({static_cast<double>(at) / points, 0.0});
      if (on[at] != 0) continue;
      if (was_on) {
        double fall = static_cast<double>(at) / points;
        if (fall <= intervals.back().rise) fall += 1.0;
        intervals.back().fall = fall;
      }
    }
    std::sort(intervals.begin(), intervals.end(),
              [](const OnInterval& a, const OnInterval& b) { return a.rise < b.rise; });
    waveform = Waveform::binary(
        std::move(intervals), most_level == 1.0 ? 1.0 : points / static_cast<double>(points_on()));
  }
};

struct Settled {
  RoundedArm modulation, demodulation;
  double residual_rms = std::numeric_limits<double>::infinity();

  WaveformPair pair() const { return {modulation.waveform, demodulation.waveform}; }
};

bool is_valid(const Settled& one, const PairModel& model) {
  for (const RoundedArm* arm : {&one.modulation, &one.demodulation})
    if ((!arm->on.empty() && !arm->is_playable()) ||
        !keeps_shortest_run(arm->waveform, model.shortest_run()))
      return false;
  return true;
}

/// Moves each switching time by one point if that reduces the residual; returns true if one moved.
bool move_edges(RoundedArm Settled::*which, const PairModel& model, Settled& best) {
  bool is_better = false;
  const std::size_t points = (best.*which).on.size();
  for (std::size_t i = 0; i < points; ++i)
    for (const std::size_t flipped : {i, (i + points - 1) % points}) {
      const std::vector<char>& on = (best.*which).on;
      if (on[i] == on[(i + points - 1) % points]) break;  // no edge
      Settled moved = best;
      RoundedArm& arm = moved.*which;
      arm.on[flipped] = arm.on[flipped] == 0;
      arm.render();
      if (!is_valid(moved, model)) continue;
      moved.residual_rms = model.residual_rms(moved.pair());
      if (moved.residual_rms >= best.residual_rms * (1 - 1e-9)) continue;
      best = std::move(moved);
      is_better = true;
    }
  return is_better;
}

}  // namespace

std::optional<WaveformPair> settle_on_points(const PairModel& model, const WaveformPair& pair) {
  const int m_points = coarse_points(model.camera().light.generator, model),
            d_points = coarse_points(model.camera().sensor.generator, model);
  if (m_points + d_points == 0 || !pair.modulation.is_binary() || !pair.demodulation.is_binary())
    return std::nullopt;

  std::optional<Settled> best;
  for (int i = 0; i < delays_per_point; ++i) {
    const double delay = static_cast<double>(i) / delays_per_point / std::max(m_points, d_points);
    Settled rounded{RoundedArm(pair.modulation.delayed(delay), m_points, model.peak_factor()),
                    RoundedArm(pair.demodulation.delayed(delay), d_points, 1.0)};
    if (!is_valid(rounded, model)) continue;
    rounded.residual_rms = model.residual_rms(rounded.pair());
    if (!best || rounded.residual_rms < best->residual_rms) best = std::move(rounded);
  }
  if (!best) return std::nullopt;
  bool is_better = true;
  for (int round = 0; is_better && round < max_settling_rounds; ++round) {
    is_better = move_edges(&Settled::modulation, model, *best);
    is_better = move_edges(&Settled::demodulation, model, *best) || is_better;
  }
  return best->pair();
}

namespace {

constexpr double pi = std::numbers::pi;
constexpr double duty_weight = 2.0;  // of (mean d - target mean), relative to the harmonics
constexpr double fading_run = 2e-3;  // in periods; shorter runs vanish in the fit
constexpr int max_rounds = 4;        // of fitting and removing short runs

/// Fourier coefficients of a binary waveform with level 1, and their derivatives:
///   X[n] = sum_j s_j exp(-2 pi i n e_j) / (2 pi i n), s = +1 at rises, -1 at falls.
void harmonics_of_edges(const Eigen::VectorXd& times, int highest, Eigen::VectorXcd& harmonics,
                        Eigen::MatrixXcd& derivatives) {
  using namespace std::complex_literals;
  harmonics = Eigen::VectorXcd::Zero(highest + 1);
  derivatives.resize(highest + 1, times.size());
  for (Eigen::Index j = 0; j < times.size(); ++j) {
    const double sign = j % 2 == 0 ? 1.0 : -1.0;
    const std::complex<double> turn = std::polar(1.0, -2 * pi * times[j]);
    std::complex<double> phase = 1.0;
    harmonics[0] -= sign * times[j];
    derivatives(0, j) = -sign;
    for (int n = 1; n <= highest; ++n) {
      phase *= turn;
      harmonics[n] += sign * phase / (2i * pi * static_cast<double>(n));
      derivatives(n, j) = -sign * phase;
    }
  }
}

/// Residuals Z[n] = D[n] conj(M[n]) H[n] - T[n], weighted by Parseval, and one for the duty of d,
/// for Eigen's Levenberg-Marquardt.
class HarmonicFit {
 public:
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  HarmonicFit(const PairModel& model, const WaveformPair& start)
      : modulation_(start.modulation, 1.0 / model.peak_factor()),
        demodulation_(start.demodulation, 0.0),
        demodulation_mean_(model.target().demodulation_mean),
        shortest_run_(std::max(fading_run, model.shortest_run())) {
    const int samples = model.samples();
    const Eigen::VectorXcd response = model.camera().transfer(samples / 2);
    highest_ = samples / 2;
    while (highest_ > 8 && std::abs(response[highest_]) < 1e-5) --highest_;
    transfer_ = response.head(highest_ + 1);
    const Eigen::VectorXcd spectrum = model.spectrum(model.target_samples());
    target_.resize(highest_ + 1);
    for (int n = 0; n <= highest_; ++n) {
      // Linear interpolation multiplies the transform of the samples by sinc^2.
      const double x = pi * n / samples;
      const double sinc = n == 0 ? 1.0 : std::sin(x) / x;
      target_[n] = spectrum[n] / static_cast<double>(samples) * sinc * sinc;
    }
  }

  int inputs() const {
    return static_cast<int>(modulation_.parameter_count() + demodulation_.parameter_count());
  }
  int values() const { return std::max(2 * highest_ + 2, inputs()); }

  Eigen::VectorXd start() const {
    Eigen::VectorXd parameters(inputs());
    parameters << modulation_.parameters(), demodulation_.parameters();
    return parameters;
  }

  int operator()(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals) const {
    evaluate(parameters, &residuals, nullptr);
    return 0;
  }
  int df(const Eigen::VectorXd& parameters, Eigen::MatrixXd& jacobian) const {
    evaluate(parameters, nullptr, &jacobian);
    return 0;
  }

  WaveformPair pair(const Eigen::VectorXd& parameters) const {
    return {
        modulation_.waveform(parameters.head(modulation_.parameter_count()), shortest_run_),
        demodulation_.waveform(parameters.tail(demodulation_.parameter_count()), shortest_run_)};
  }

 private:
  void evaluate(const Eigen::VectorXd& parameters, Eigen::VectorXd* residuals,
                Eigen::MatrixXd* jacobian) const {
    const Eigen::Index count = modulation_.parameter_count();
    Eigen::VectorXd m_times, d_times;
    Eigen::MatrixXd m_chain, d_chain;
    modulation_.edges(parameters.head(count), m_times, m_chain);
    demodulation_.edges(parameters.tail(demodulation_.parameter_count()), d_times, d_chain);
    Eigen::VectorXcd m, d;
    Eigen::MatrixXcd m_derivatives, d_derivatives;
    harmonics_of_edges(m_times, highest_, m, m_derivatives);
    harmonics_of_edges(d_times, highest_, d, d_derivatives);
    // Unit mean power: M = U / duty.
    const double duty = m[0].real();
    const Eigen::RowVectorXcd duty_derivatives = m_derivatives.row(0);
    m /= duty;
    m_derivatives = (m_derivatives - m * duty_derivatives) / duty;

    if (residuals) {
      residuals->setZero(values());
      for (int n = 0; n <= highest_; ++n)
        put(*residuals, n, d[n] * std::conj(m[n]) * transfer_[n] - target_[n]);
      (*residuals)[2 * highest_ + 1] = duty_weight * (d[0].real() - demodulation_mean_);
    }
    if (jacobian) {
      jacobian->setZero(values(), inputs());
      const Eigen::MatrixXcd by_m =
          (transfer_.cwiseProduct(d)).asDiagonal() *
          (m_derivatives.conjugate() * m_chain.cast<std::complex<double>>());
      const Eigen::MatrixXcd by_d = (transfer_.cwiseProduct(m.conjugate())).asDiagonal() *
                                    (d_derivatives * d_chain.cast<std::complex<double>>());
      for (int n = 0; n <= highest_; ++n) {
        for (Eigen::Index j = 0; j < count; ++j) put(jacobian->col(j), n, by_m(n, j));
        for (Eigen::Index j = 0; j < by_d.cols(); ++j) put(jacobian->col(count + j), n, by_d(n, j));
      }
      jacobian->row(2 * highest_ + 1).tail(by_d.cols()) =
          duty_weight * d_derivatives.row(0).real() * d_chain;
    }
  }

  template <typename Column>
  static void put(Column&& column, int n, std::complex<double> value) {
    if (n == 0) {
      column[0] = value.real();
    } else {
      column[2 * n - 1] = std::numbers::sqrt2 * value.real();
      column[2 * n] = std::numbers::sqrt2 * value.imag();
    }
  }

  RunLengths modulation_, demodulation_;
  double demodulation_mean_;
  double shortest_run_;
  int highest_ = 0;
  Eigen::VectorXcd transfer_, target_;
};

bool switches(const Waveform& waveform) {
  return waveform.is_binary() && waveform.duty() > 0.0 && waveform.duty() < 1.0;
}

}  // namespace

std::optional<WaveformPair> refine_edges(const PairModel& model, const WaveformPair& start) {
  if (!switches(start.modulation) || !switches(start.demodulation)) return std::nullopt;
  WaveformPair pair = start;
  for (int round = 0; round < max_rounds; ++round) {
    HarmonicFit fit(model, pair);
    Eigen::VectorXd parameters = fit.start();
    Eigen::LevenbergMarquardt<HarmonicFit> solver(fit);
    solver.parameters.maxfev = 100;
    solver.parameters.ftol = solver.parameters.xtol = 1e-9;
    solver.minimize(parameters);
    if (!parameters.allFinite()) return pair;
    const int edges_before = pair.modulation.edges() + pair.demodulation.edges();
    WaveformPair moved = fit.pair(parameters);
    if (!switches(moved.modulation) || !switches(moved.demodulation)) return pair;
    pair = std::move(moved);
    if (pair.modulation.edges() + pair.demodulation.edges() == edges_before) break;
  }
  return pair;
}

}  // namespace tofsmith
