// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/forward_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/shared/periodic.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

/// Integral of a periodic step function from 0 to t, for any real t.
class Integral {
 public:
  explicit Integral(const StepFunction& function) : function_(function), at_breakpoint_{0.0} {
    TOFSMITH_ASSERT_EQ(function.breakpoints.front(), 0.0);
    for (std::size_t i = 0; i < function.values.size(); ++i)
      at_breakpoint_.push_back(at_breakpoint_.back() + function.values[i] * (end(i) - begin(i)));
  }
  double operator()(double t) const {
    const double whole = std::floor(t);
    const double u = t - whole;
    const auto after =
        std::upper_bound(function_.breakpoints.begin(), function_.breakpoints.end(), u);
    const auto i = static_cast<std::size_t>(after - function_.breakpoints.begin()) - 1;
    return whole * at_breakpoint_.back() + at_breakpoint_[i] + function_.values[i] * (u - begin(i));
  }

 private:
  double begin(std::size_t i) const { return function_.breakpoints[i]; }
  double end(std::size_t i) const {
    return i + 1 < function_.breakpoints.size() ? function_.breakpoints[i + 1] : 1.0;
  }
  const StepFunction& function_;
  std::vector<double> at_breakpoint_;
};

/// Sorts positions in [0, 1) that begin with 0, and removes duplicates.
void sort_corners(std::vector<double>& corners) {
  std::sort(corners.begin(), corners.end());
  constexpr double same = 1e-12;  // rounding error
  const auto last =
      std::unique(corners.begin(), corners.end(), [](double a, double b) { return b - a < same; });
  corners.erase(last, corners.end());
  while (corners.size() > 1 && corners.back() > 1.0 - same) corners.pop_back();
}

/// Sorted positions at which the correlation of two step functions changes slope.
std::vector<double> corner_positions(const StepFunction& d, const StepFunction& m) {
  std::vector<double> corners{0.0};
  corners.reserve(d.breakpoints.size() * m.breakpoints.size() + 1);
  for (const double t : d.breakpoints)
    for (const double s : m.breakpoints) corners.push_back(wrap(t - s, 1.0));
  sort_corners(corners);
  return corners;
}

/// Number of equal cells such that both functions change only at cell borders; 0 if the closest
/// breakpoints of a function define no such cells.
int common_cells(const StepFunction& d, const StepFunction& m) {
  double closest = 1.0;
  for (const StepFunction* function : {&d, &m})
    for (std::size_t i = 1; i < function->breakpoints.size(); ++i)
      closest = std::min(closest, function->breakpoints[i] - function->breakpoints[i - 1]);
  const double cells = std::round(1.0 / closest);
  constexpr double max_cells = 1 << 20;
  if (!(cells <= max_cells)) return 0;
  for (const StepFunction* function : {&d, &m})
    for (const double t : function->breakpoints)
      if (std::abs(t * cells - std::round(t * cells)) > 1e-6) return 0;
  return static_cast<int>(cells);
}

Eigen::VectorXd cell_values(const StepFunction& function, int cells) {
  Eigen::VectorXd values(cells);
  for (std::size_t i = 0; i < function.values.size(); ++i) {
    const bool last = i + 1 == function.values.size();
    const auto begin = std::lround(function.breakpoints[i] * cells);
    const auto end = last ? cells : std::lround(function.breakpoints[i + 1] * cells);
    values.segment(begin, end - begin).setConstant(function.values[i]);
  }
  return values;
}

/// Interpolates at `position` in [0, 1), between corner i and the next one.
double between_corners(const std::vector<double>& corners, const std::vector<double>& values,
                       std::size_t i, double position) {
  const bool last = i + 1 == corners.size();
  const double end = last ? 1.0 + corners[0] : corners[i + 1];
  const double value_at_end = last ? values[0] : values[i + 1];
  const double share = (position - corners[i]) / (end - corners[i]);
  return values[i] + share * (value_at_end - values[i]);
}

/// Total variation over one period, or an upper bound.
double variation(const Waveform& waveform) {
  if (waveform.is_binary())
    return 2.0 * waveform.level() * static_cast<double>(waveform.on_intervals().size());
  double sum = 0.0;  // variations of all cosines
  for (Eigen::Index n = 1; n < waveform.coefficients().size(); ++n)
    sum += 8.0 * static_cast<double>(n) * std::abs(waveform.coefficients()[n]);
  if (!waveform.is_sampled()) return sum;
  const Eigen::VectorXd& x = waveform.samples();
  return (x - circular_shift(x, 1)).cwiseAbs().sum();
}

/// Highest harmonic that both waveforms have; no_end if neither is band-limited.
constexpr int no_end = std::numeric_limits<int>::max();
int last_harmonic(const Waveform& d, const Waveform& m) {
  int last = no_end;
  for (const Waveform* waveform : {&d, &m})
    if (const auto size = static_cast<int>(waveform->coefficients().size()); size > 0)
      last = std::min(last, size - 1);
  return last;
}

/// Highest harmonic above rounding error: the sum of all higher ones is negligible. Harmonic n of a
/// waveform is at most variation / (2 pi n).
int last_that_counts(const Waveform& d, const Waveform& m, const Eigen::VectorXcd& transfer) {
  constexpr double rounding = 1e-15;
  const double allowed = rounding * d.mean() * m.mean() / (variation(d) * variation(m));
  double left_out = 0.0;
  Eigen::Index n = std::min<Eigen::Index>(transfer.size() - 1, last_harmonic(d, m));
  for (; n > 0; --n) {
    const double larger = std::abs(transfer[n].real()) + std::abs(transfer[n].imag());
    left_out += 2.0 * larger / std::pow(2.0 * std::numbers::pi * static_cast<double>(n), 2);
    if (!(left_out <= allowed)) break;
  }
  return static_cast<int>(n);
}

}  // namespace

CorrelationFunction::CorrelationFunction(const Waveform& demodulation, const Waveform& modulation) {
  if (const int last = last_harmonic(demodulation, modulation); last < no_end) {
    harmonics_ = demodulation.harmonics(last).cwiseProduct(modulation.harmonics(last).conjugate());
    return;
  }
  const StepFunction d = demodulation.steps(), m = modulation.steps();
  // Each pair of breakpoints yields a corner. Many pairs usually mean a common grid, on which most
  // corners coincide.
  const double pairs =
      static_cast<double>(d.breakpoints.size()) * static_cast<double>(m.breakpoints.size());
  constexpr double many_pairs = 1 << 12, max_pairs = 1 << 27;
  if (pairs > many_pairs)
    if (const int cells = common_cells(d, m); cells > 0) {
      const Eigen::VectorXd of_d = cell_values(d, cells), of_m = cell_values(m, cells);
      Eigen::VectorXd values = circular_correlation(of_d, of_m) / cells;
      if (of_d.minCoeff() >= 0.0 && of_m.minCoeff() >= 0.0)
        values = values.cwiseMax(0.0);  // negative rounding errors
      for (int i = 0; i < cells; ++i) corners_.push_back(static_cast<double>(i) / cells);
      values_.assign(values.begin(), values.end());
      return;
    }
  require(pairs <= max_pairs, "switching times", pairs,
          "must be at most 2^27 pairs of modulation and demodulation, or lie on a common grid");
  const Integral integral(d);
  corners_ = corner_positions(d, m);
  values_.reserve(corners_.size());
  for (const double u : corners_) {
    double sum = 0.0;
    for (std::size_t i = 0; i < m.values.size(); ++i) {
      if (m.values[i] == 0.0) continue;
      const double end = i + 1 < m.breakpoints.size() ? m.breakpoints[i + 1] : 1.0;
      sum += m.values[i] * (integral(end + u) - integral(m.breakpoints[i] + u));
    }
    values_.push_back(sum);
  }
}

CorrelationFunction::CorrelationFunction(const Waveform& demodulation, const Waveform& modulation,
                                         const Eigen::VectorXcd& transfer) {
  const int highest = last_that_counts(demodulation, modulation, transfer);
  harmonics_ = demodulation.harmonics(highest)
                   .cwiseProduct(modulation.harmonics(highest).conjugate())
                   .cwiseProduct(transfer.head(highest + 1));
}

CorrelationFunction CorrelationFunction::moved(double delay, bool reversed) const {
  CorrelationFunction result;
  const double sign = reversed ? -1.0 : 1.0;
  if (harmonics_.size() > 0) {
    result.harmonics_ = reversed ? harmonics_.conjugate().eval() : harmonics_;
    for (Eigen::Index n = 1; n < harmonics_.size(); ++n)
      result.harmonics_[n] *=
          std::polar(1.0, -2 * std::numbers::pi * wrap(static_cast<double>(n) * delay, 1.0));
    return result;
  }
  result.corners_ = {0.0};
  for (const double corner : corners_) result.corners_.push_back(wrap(sign * corner + delay, 1.0));
  sort_corners(result.corners_);
  for (const double u : result.corners_) result.values_.push_back((*this)(sign * (u - delay)));
  return result;
}

double CorrelationFunction::operator()(double u) const {
  if (harmonics_.size() > 0) {
    const std::complex<double> turn = std::polar(1.0, 2 * std::numbers::pi * wrap(u, 1.0));
    std::complex<double> sum = 0.0;  // Horner's method
    for (Eigen::Index n = harmonics_.size() - 1; n >= 1; --n) sum = (sum + harmonics_[n]) * turn;
    return harmonics_[0].real() + 2.0 * sum.real();
  }
  const double position = wrap(u, 1.0);
  const auto after = std::upper_bound(corners_.begin(), corners_.end(), position);
  return between_corners(corners_, values_, static_cast<std::size_t>(after - corners_.begin()) - 1,
                         position);
}

bool CorrelationFunction::has_corners_at(int points) const {
  constexpr double rounding = 1e-6;
  return harmonics_.size() == 0 &&
         std::all_of(corners_.begin(), corners_.end(), [&](double corner) {
           return std::abs(corner * points - std::round(corner * points)) <= rounding;
         });
}

Eigen::VectorXd CorrelationFunction::table(int points) const {
  require(points >= 1, "points", points, "must be >= 1");
  Eigen::VectorXd values(points);
  if (harmonics_.size() == 0) {
    std::size_t corner = 0;
    for (int j = 0; j < points; ++j) {
      const double position = static_cast<double>(j) / points;
      while (corner + 1 < corners_.size() && corners_[corner + 1] <= position) ++corner;
      values[j] = between_corners(corners_, values_, corner, position);
    }
    return values;
  }
  // Harmonics above points/2 alias to lower ones, which is exact at the points.
  std::vector<std::complex<double>> folded(static_cast<std::size_t>(points), 0.0);
  folded[0] = harmonics_[0].real();
  for (Eigen::Index n = 1; n < harmonics_.size(); ++n) {
    const auto k = static_cast<std::size_t>(n % points);
    folded[k] += harmonics_[n];
    folded[k == 0 ? 0 : static_cast<std::size_t>(points) - k] += std::conj(harmonics_[n]);
  }
  const PeriodicTransform transform(points);
  Eigen::VectorXcd spectrum(transform.coefficients());
  for (Eigen::Index k = 0; k < spectrum.size(); ++k)
    spectrum[k] = folded[static_cast<std::size_t>(k)] * static_cast<double>(points);
  transform.inverse(spectrum, values);
  return values;
}

}  // namespace tofsmith
