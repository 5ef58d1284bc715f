// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/correlation_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "calibrate/harmonic_fit.hpp"
#include "calibrate/sweep_pixels.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using Kind = ImpulseResponse::Kind;

Eigen::MatrixXcd harmonics_of(const Eigen::MatrixXd& table, int harmonics) {
  std::vector<double> places;
  for (Eigen::Index n = 0; n < table.rows(); ++n)
    places.push_back(static_cast<double>(n) / static_cast<double>(table.rows()));
  Eigen::MatrixXcd c = HarmonicBasis(places, harmonics).coefficients(table);
  c.row(0).setZero();
  return c;
}

Camera unlimited_camera(Camera camera) {
  camera.light.impulse_response = camera.sensor.impulse_response = {};
  camera.light.edge_jitter_s = camera.sensor.edge_jitter_s = 0.0;
  camera.light.generator.reset();
  camera.sensor.generator.reset();
  camera.light.peak_factor = 1e6;
  camera.light.binary = camera.sensor.binary = false;
  camera.sensor.modulation_contrast = 1.0;
  camera.sensor.modulation_contrasts.clear();
  camera.sensor.tap_mismatch = 0.0;
  camera.exposure_s.each_s.clear();
  camera.playback.reset();
  return camera;
}

/// Transfer by two equal arms.
double both_arms(Kind kind, double parameter_hz, double frequency_hz) {
  const ImpulseResponse response{.kind = kind, .f_max_hz = parameter_hz, .cutoff_hz = parameter_hz};
  return std::norm(response.transfer(frequency_hz));
}

Eigen::MatrixXcd limited(Eigen::MatrixXcd c, Kind kind, double parameter_hz, double f0_hz) {
  for (Eigen::Index n = 1; kind != Kind::none && n < c.rows(); ++n)
    c.row(n) *= both_arms(kind, parameter_hz, f0_hz * static_cast<double>(n));
  return c;
}

/// Least squares fit of y by x.
struct Match {
  double left = INFINITY;  // |y - scale x(u - delay)|^2
  double scale = 0.0;
  double delay = 0.0;
};

Match match(const Eigen::MatrixXcd& y, const Eigen::MatrixXcd& x) {
  Eigen::VectorXcd s = y.cwiseProduct(x.conjugate()).rowwise().sum();
  s[0] = 0.0;
  const BestShift best = best_shift(s);
  const double size = x.squaredNorm();
  if (!(size > 0.0)) return {};
  return {y.squaredNorm() - best.value * best.value / size, best.value / size, -best.shift};
}

Eigen::MatrixXcd ordered(const Eigen::MatrixXcd& x, const std::vector<int>& order, int taps) {
  Eigen::MatrixXcd result(x.rows(), x.cols());
  for (std::size_t e = 0; e < order.size(); ++e)
    result.middleCols(static_cast<Eigen::Index>(e) * taps, taps) =
        x.middleCols(static_cast<Eigen::Index>(order[e]) * taps, taps);
  return result;
}

/// Applies the direction, sign and order with the smallest residual to x.
void orient(const Eigen::MatrixXcd& y, Eigen::MatrixXcd& x, int taps, IdealCodeFit& fit) {
  const Eigen::MatrixXcd original = x;
  std::vector<int> order(static_cast<std::size_t>(x.cols() / taps));
  std::iota(order.begin(), order.end(), 0);
  const bool permute = order.size() <= 5;
  double min_left = INFINITY;
  do {
    for (const bool reversed : {false, true})
      for (const bool inverted : {false, true}) {
        Eigen::MatrixXcd turned = ordered(reversed ? original.conjugate() : original, order, taps);
        if (inverted) turned = -turned;
        const Match found = match(y, turned);
        // Symmetric codes give ties; keep the first variant (unchanged).
        if (found.left >= min_left - 1e-6 * y.squaredNorm()) continue;
        min_left = found.left;
        x = std::move(turned);
        fit.reversed = reversed;
        fit.inverted = inverted;
        fit.exposure = order;
      }
  } while (permute && std::next_permutation(order.begin(), order.end()));
}

double golden(double low, double high, const std::function<double(double)>& f) {
  constexpr double share = 0.6180339887498949;
  double a = high - share * (high - low), b = low + share * (high - low);
  double fa = f(a), fb = f(b);
  for (int i = 0; i < 60; ++i) {
    if (fa < fb) {
      high = b, b = a, fb = fa, a = high - share * (high - low), fa = f(a);
    } else {
      low = a, a = b, fa = fb, b = low + share * (high - low), fb = f(b);
    }
  }
  return 0.5 * (low + high);
}

void fit_response(const Eigen::MatrixXcd& y, const Eigen::MatrixXcd& x, double f0_hz,
                  IdealCodeFit& fit) {
  const double total = y.squaredNorm();
  Match best = match(y, x);
  fit.ideal_residual = std::sqrt(std::max(0.0, best.left) / total);
  for (const Kind kind : {Kind::hann, Kind::gaussian, Kind::lowpass}) {
    const auto left = [&](double log_hz) {
      return match(y, limited(x, kind, std::exp(log_hz), f0_hz)).left;
    };
    const double low = std::log(0.3 * f0_hz);
    const double high = std::log(4 * f0_hz * static_cast<double>(x.rows()));
    double start = low;
    constexpr int steps = 40;
    for (int i = 1; i <= steps; ++i)
      if (const double at = low + (high - low) * i / steps; left(at) < left(start)) start = at;
    const double reach = (high - low) / steps;
    const double log_hz = golden(start - reach, start + reach, left);
    const Match found = match(y, limited(x, kind, std::exp(log_hz), f0_hz));
    if (found.left >= best.left * (1 - 1e-3)) continue;
    best = found;
    fit.response = {.kind = kind};
    (kind == Kind::hann ? fit.response.f_max_hz : fit.response.cutoff_hz) = std::exp(log_hz);
    // Standard error from the curvature over the logarithm of the parameter.
    const double move = 1e-2;
    const double curvature =
        (left(log_hz + move) - 2 * found.left + left(log_hz - move)) / (move * move);
    const double noise = std::max(0.0, found.left) / static_cast<double>(std::max<Eigen::Index>(
                                                         1, 2 * (y.size() - y.cols()) - 3));
    fit.parameter_hz = {std::exp(log_hz),
                        std::exp(log_hz) * std::sqrt(2 * noise / std::max(1e-300, curvature))};
  }
  fit.residual = std::sqrt(std::max(0.0, best.left) / total);
  fit.scale = best.scale;
  fit.delay_periods = best.delay;
}

void add_harmonics(const Eigen::MatrixXcd& y, const Eigen::MatrixXcd& ideal, double noise,
                   IdealCodeFit& fit) {
  const Eigen::MatrixXcd moved = fit.scale * advanced(ideal, -fit.delay_periods);
  const double largest = moved.cwiseAbs().maxCoeff();
  for (Eigen::Index n = 1; n < std::min<Eigen::Index>(17, y.rows()); ++n) {
    const double size2 = moved.row(n).squaredNorm();
    HarmonicRatio h{.harmonic = static_cast<int>(n),
                    .measured = 2 * y.row(n).norm(),
                    .ideal = 2 * std::sqrt(size2),
                    .ratio = {NAN, NAN}};
    if (std::sqrt(size2) > 1e-3 * largest)
      h.ratio = {y.row(n).dot(moved.row(n)).real() / size2, noise / std::sqrt(size2)};
    fit.harmonics.push_back(h);
  }
}

}  // namespace

std::vector<CodeSet> ideal_codes(const Camera& camera, int measurements) {
  const Camera ideal = unlimited_camera(camera);
  const int taps = ideal.sensor.taps;
  const int per_exposure = ideal.sensor.readout == Readout::difference ? taps / 2 : taps;
  if (per_exposure < 1 || measurements % per_exposure != 0) return {};
  const int exposures = measurements / per_exposure;
  std::vector<CodeSet> codes;
  for (const char* pattern :
       {"sinusoid-k{}", "square-k{}", "hamiltonian-k{}", "multifrequency-k{}",
        "pulsed-multifrequency-k{}", "gray-k{}", "single-ramp-k{}", "double-ramp-k{}"}) {
    const std::string name = fmt::format(fmt::runtime(pattern), exposures);
    if (!why_no_family(name, ideal)) codes.push_back(build_family(name, ideal));
  }
  return codes;
}

std::vector<IdealCodeFit> fit_ideal_codes(const Eigen::MatrixXd& table,
                                          const Eigen::MatrixXd& error, const Camera& camera,
                                          const std::vector<CodeSet>& codes) {
  constexpr int max_harmonics = 64;
  const int harmonics = std::min(static_cast<int>(table.rows() - 1) / 2, max_harmonics);
  const Eigen::MatrixXcd y = harmonics_of(table, harmonics);
  require(y.squaredNorm() > 0.0, "table", "constant", "must change with delay");
  const Camera ideal = unlimited_camera(camera);
  const double noise = std::sqrt(error.cwiseAbs2().mean() / static_cast<double>(table.rows()) / 2);
  std::vector<IdealCodeFit> fits;
  for (const CodeSet& code : codes) {
    const ForwardModel model(code, ideal);
    if (model.measurements() != table.cols()) continue;
    IdealCodeFit fit{.code = code.name()};
    const Eigen::MatrixXcd x0 = harmonics_of(model.correlation_table(1920), harmonics);
    if (!(x0.squaredNorm() > 0.0)) continue;
    Eigen::MatrixXcd x = x0;
    orient(y, x, static_cast<int>(table.cols()) / code.exposures(), fit);
    fit_response(y, x, camera.fundamental_frequency_hz, fit);
    const double parameter_hz = fit.parameter_hz.value;
    const Eigen::MatrixXcd passed =
        limited(x, fit.response.kind, parameter_hz, camera.fundamental_frequency_hz);
    fit.fitted =
        curve_of(fit.scale * advanced(passed, -fit.delay_periods), static_cast<int>(table.rows()));
    add_harmonics(y, x, noise, fit);
    fits.push_back(std::move(fit));
  }
  require(!fits.empty(), "codes", codes.size(),
          fmt::format("must contain a code of {} measurements, as in the table", table.cols()));
  std::ranges::stable_sort(fits, {}, &IdealCodeFit::residual);
  return fits;
}

Camera with_fit(Camera camera, const IdealCodeFit& fit, const std::vector<Estimate>& tap_mismatch) {
  camera.light.impulse_response = camera.sensor.impulse_response = fit.response;
  // Smaller shifts are not significant.
  constexpr double least_delay_periods = 1e-3;
  Playback playback{.reversed = fit.reversed, .inverted = fit.inverted};
  if (std::abs(fit.delay_periods) >= least_delay_periods)
    playback.offset_m = -fit.delay_periods * camera.range_m();
  if (!std::ranges::is_sorted(fit.exposure)) playback.order = fit.exposure;
  camera.playback.reset();
  if (playback != Playback()) camera.playback = playback;
  if (!tap_mismatch.empty()) {
    const Estimate mean = mean_of(tap_mismatch);
    if (std::abs(mean.value) > 3 * mean.standard_error) camera.sensor.tap_mismatch = mean.value;
  }
  camera.validate();
  return camera;
}

}  // namespace tofsmith
