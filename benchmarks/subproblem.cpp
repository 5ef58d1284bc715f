// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Time of a circulant total-variation subproblem, in units of one forward and one inverse real
// Fourier transform of its length in the same run, for comparisons between machines. A
// general-purpose QP solver needs about 400 ms at N = 1000.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "core/shared/periodic.hpp"
#include "design/circulant_tv/circulant_tv_certificate.hpp"
#include "tofsmith/design/circulant_tv.hpp"

namespace {

using tofsmith::CirculantTvProblem;
using tofsmith::CirculantTvResult;
using tofsmith::CirculantTvSolver;

// Median of calls, in batches of about a millisecond [s].
template <typename Work>
double median_seconds(Work&& work) {
  using clock = std::chrono::steady_clock;
  const auto seconds_of = [&](int calls) {
    const auto start = clock::now();
    for (int call = 0; call < calls; ++call) work();
    return std::chrono::duration<double>(clock::now() - start).count() / calls;
  };
  const int calls = std::clamp(static_cast<int>(1e-3 / seconds_of(3)), 1, 1000);
  std::vector<double> seconds(41);
  for (double& value : seconds) value = seconds_of(calls);
  std::nth_element(seconds.begin(), seconds.begin() + 20, seconds.end());
  return seconds[20];
}

// On and off runs, in units of 1 / `units` of the period.
Eigen::VectorXd binary_code(int samples, const std::vector<int>& runs, int units, int shift) {
  Eigen::VectorXd code(samples);
  for (int n = 0; n < samples; ++n) {
    double place = units * ((n + 0.5) / samples) - shift;
    if (place < 0) place += units;
    std::size_t run = 0;
    for (double end = runs[0]; place >= end && run + 1 < runs.size(); end += runs[run]) ++run;
    code[n] = run % 2 == 0 ? 1 : 0;
  }
  return code;
}

Eigen::VectorXd smoothed_twice(const Eigen::VectorXd& x, int width) {
  Eigen::VectorXd window = Eigen::VectorXd::Zero(x.size());
  for (int i = 0; i < width; ++i)
    window[(i - width / 2 + x.size()) % x.size()] =
        0.5 - 0.5 * std::cos(2 * std::numbers::pi * (i + 1) / (width + 1));
  window /= window.sum();
  return tofsmith::circular_convolution(tofsmith::circular_convolution(x, window), window);
}

// The modulation of a Hamiltonian code, for its demodulation and ideal correlation function.
CirculantTvProblem hamiltonian_problem(int samples, const std::vector<int>& runs, int units,
                                       int shift, double peak_factor, bool band_limited) {
  Eigen::VectorXd demodulation = binary_code(samples, runs, units, shift);
  const Eigen::VectorXd pulse = units * binary_code(samples, {1, units - 1}, units, 0);
  CirculantTvProblem problem;
  problem.target = tofsmith::circular_correlation(demodulation, pulse) / samples;
  if (band_limited) demodulation = smoothed_twice(demodulation, samples / 10);
  problem.kernel = demodulation / samples;
  problem.total_variation_weight = 2e-5 * samples;
  problem.upper_bound = peak_factor;
  problem.budget = samples;
  return problem;
}

void report(const char* name, const CirculantTvProblem& problem) {
  const int samples = problem.samples();
  const tofsmith::PeriodicTransform transform(samples);
  Eigen::VectorXd signal = problem.target;
  Eigen::VectorXcd spectrum;
  const auto time_transforms = [&] {
    return median_seconds([&] {
      transform.forward(signal, spectrum);
      transform.inverse(spectrum, signal);
    });
  };
  const double before = time_transforms();

  CirculantTvSolver solver(samples);
  // Different kernels prevent reuse of transforms.
  std::vector<CirculantTvProblem> variants(2, problem);
  variants[1].kernel *= 1 + 1e-12;
  std::size_t turn = 0;
  CirculantTvResult cold;
  const double cold_seconds = median_seconds([&] { cold = solver.solve(variants[turn++ % 2]); });

  // A slightly different target, as in the next step of the alternation.
  for (CirculantTvProblem& variant : variants)
    for (int n = 0; n < samples; ++n) variant.target[n] += 0.003 * std::sin(40.0 * n / samples);
  CirculantTvResult warm;
  const double warm_seconds =
      median_seconds([&] { warm = solver.solve(variants[turn++ % 2], {}, cold.x); });

  const double unit = 0.5 * (before + time_transforms());
  const double worst = std::max(tofsmith::certificate(problem, cold.x).worst(),
                                tofsmith::certificate(variants[0], warm.x).worst());
  fmt::print(
      "{:<24} {:>5} {:>8.1f} {:>9.3f} {:>7.1f} {:>6} {:>7} {:>7} {:>9.3f} {:>7.1f} {:>6} "
      "{:>9.1e}\n",
      name, samples, unit * 1e6, cold_seconds * 1e3, cold_seconds / unit, cold.iterations,
      cold.newton_steps, cold.pieces, warm_seconds * 1e3, warm_seconds / unit, warm.iterations,
      worst);
  std::fflush(stdout);
}

}  // namespace

int main() {
  fmt::print(
      "One unit is one forward and one inverse real transform of length N. For comparison: a\n"
      "prototype that takes its gradients by FFTW needs about 75 of FFTW's units at N = 1000.\n\n");
  fmt::print("{:<24} {:>5} {:>8} {:>9} {:>7} {:>6} {:>7} {:>7} {:>9} {:>7} {:>6} {:>9}\n",
             "problem", "N", "unit us", "cold ms", "units", "scans", "newton", "pieces", "warm ms",
             "units", "scans", "violation");
  for (const int samples : {240, 1000, 4096}) {
    report("K=3, p=4", hamiltonian_problem(samples, {3, 3}, 6, 0, 4, false));
    report("K=5 code 4, p=15, 10 f0",
           hamiltonian_problem(samples, {4, 4, 4, 4, 3, 4, 4, 3}, 30, 1, 15, true));
  }
}
