// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/circulant_tv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/shared/periodic.hpp"
#include "core/shared/random.hpp"
#include "design/circulant_tv/circulant_tv_admm.hpp"
#include "design/circulant_tv/proximal_operators.hpp"
#include "refusal.hpp"

namespace tofsmith {

namespace {

constexpr double tolerance = 1e-7;

/// Convolves with a centred Hann window of `width` samples and sum 1.
Eigen::VectorXd smoothed(const Eigen::VectorXd& x, int width) {
  Eigen::VectorXd window = Eigen::VectorXd::Zero(x.size());
  for (int i = 0; i < width; ++i)
    window[(i - width / 2 + x.size()) % x.size()] =
        0.5 - 0.5 * std::cos(2 * std::numbers::pi * (i + 1) / (width + 1));
  return circular_convolution(x, window / window.sum());
}

Eigen::VectorXd trapezoid_target(int samples, double pulse_duty) {
  Eigen::VectorXd square(samples), pulse(samples);
  for (int n = 0; n < samples; ++n) {
    square[n] = n + 0.5 < 0.5 * samples ? 1.0 : 0.0;
    pulse[n] = n + 0.5 < pulse_duty * samples ? 1.0 / pulse_duty : 0.0;
  }
  return circular_correlation(square, pulse) / samples;
}

/// Returns a random sub-problem of the alternating design. The fixed waveform is binary with 1 to 8
/// pulses, the target a trapezoid, noisy in half of the cases. The unknown is a demodulation (at
/// most 1, no budget) or a modulation (peak factor 2 to 30, mean at most 1).
/// @param band_limited  smooths the fixed waveform twice by a Hann window
CirculantTvProblem random_circulant_tv(int samples, double weight_per_sample, bool band_limited,
                                       RandomStream& random) {
  const auto below = [&](int count) { return static_cast<int>(random.uniform() * count); };
  CirculantTvProblem problem;
  Eigen::VectorXd waveform = Eigen::VectorXd::Zero(samples);
  const int pulses = 1 + below(8);
  int position = below(samples);
  for (int edge = 0; edge < 2 * pulses; ++edge) {
    const int length = 1 + below(std::max(1, samples / pulses));
    for (int i = 0; i < length; ++i) waveform[(position + i) % samples] = edge % 2 == 0 ? 1 : 0;
    position += length;
  }
  if (band_limited) {
    const int width = std::max(3, static_cast<int>(samples * (0.04 + 0.1 * random.uniform())));
    waveform = smoothed(smoothed(waveform, width), width);
  }
  problem.kernel = waveform / samples;
  problem.target = trapezoid_target(samples, below(2) == 0 ? 1.0 / 6 : 1.0 / 30);
  if (below(2) == 0)
    for (double& value : problem.target) value += 0.02 * random.normal();
  problem.total_variation_weight = weight_per_sample * samples;
  constexpr double peaks[] = {1, 2, 4, 8, 15, 30};
  problem.upper_bound = peaks[below(6)];
  if (problem.upper_bound > 1) problem.budget = samples;
  return problem;
}

CirculantTvProblem instance(std::uint64_t item, double weight_per_sample = 2e-5, int samples = 240,
                            std::optional<bool> band_limited = {}) {
  RandomStream random(7, item);
  return random_circulant_tv(samples, weight_per_sample, band_limited.value_or(item % 2 == 1),
                             random);
}

void expect_solved(const CirculantTvProblem& problem, const CirculantTvResult& result) {
  EXPECT_EQ(result.termination, Termination::converged) << result.iterations;
  EXPECT_TRUE(result.is_usable());
  EXPECT_LE(result.certificate, tolerance);
  const OptimalityCertificate judged = certificate(problem, result.x);
  EXPECT_LE(judged.violation, tolerance) << result.iterations;
  EXPECT_LE(judged.infeasibility, 1e-12);
  EXPECT_NEAR(result.objective, problem.objective(result.x), 1e-11 * (1 + result.objective));
}

// Unoptimized and sanitized builds test a sample of the instances.
#ifdef NDEBUG
constexpr int instances_per_length = 63;
#else
constexpr int instances_per_length = 8;
#endif

class CirculantTvInstances : public testing::TestWithParam<double> {};

// Modulations and demodulations, sharp and band-limited, clean and noisy.
TEST_P(CirculantTvInstances, AreSolvedAndCertifiedWithoutFallback) {
  const double weight_per_sample = GetParam();
  for (const int samples : {120, 240, 480, 1000}) {
    CirculantTvSolver solver(samples);
    for (int item = 0; item < instances_per_length; ++item) {
      const std::uint64_t key =
          combine_keys(samples, static_cast<std::uint64_t>(1 / weight_per_sample));
      const CirculantTvProblem problem =
          instance(combine_keys(key, item), weight_per_sample, samples, item % 2 == 1);
      SCOPED_TRACE("samples " + std::to_string(samples) + ", item " + std::to_string(item));
      expect_solved(problem, solver.solve(problem));
    }
  }
}

// 252 instances each, 1260 in total. At the smallest weight, the certificate needs more digits than
// a gradient with plain double-precision sums provides.
INSTANTIATE_TEST_SUITE_P(WeightPerSample, CirculantTvInstances,
                         testing::Values(2e-5, 2e-6, 2e-7, 2e-8, 2e-9));

TEST(CirculantTv, ScalingTheTargetTheBoundsAndTheWeightScalesTheSolution) {
  constexpr double factor = 7.25;
  for (int item = 0; item < 20; ++item) {
    CirculantTvProblem problem = instance(item);
    const CirculantTvResult small = solve_circulant_tv(problem);
    problem.target *= factor;
    problem.upper_bound *= factor;
    problem.total_variation_weight *= factor;
    if (problem.budget) *problem.budget *= factor;
    const CirculantTvResult large = solve_circulant_tv(problem);
    EXPECT_NEAR(large.objective, factor * factor * small.objective, 1e-10 * large.objective);
    EXPECT_LE(certificate(problem, factor * small.x).worst(), tolerance);
  }
}

TEST(CirculantTv, AWarmStartFromTheSolutionStaysThere) {
  CirculantTvSolver solver(240);
  for (int item = 0; item < 50; ++item) {
    const CirculantTvProblem problem = instance(item);
    const CirculantTvResult cold = solver.solve(problem);
    const CirculantTvResult warm = solver.solve(problem, {}, cold.x);
    expect_solved(problem, warm);
    EXPECT_LE(warm.iterations, 3);
    EXPECT_NEAR(warm.objective, cold.objective, 1e-12 * cold.objective);
  }
}

TEST(CirculantTv, ReachesTheSameObjectiveFromAnyStart) {
  CirculantTvSolver solver(240);
  for (int item = 0; item < 30; ++item) {
    const CirculantTvProblem problem = instance(item);
    const double objective = solver.solve(problem).objective;
    RandomStream random(8, item);
    Eigen::VectorXd noise(240), pulse = Eigen::VectorXd::Zero(240);
    for (double& value : noise) value = 3 * random.normal();
    // All samples at a bound and the budget exhausted: a vertex without a free piece.
    pulse.head(static_cast<int>(240 / problem.upper_bound)).setConstant(problem.upper_bound);
    const Eigen::VectorXd full = Eigen::VectorXd::Constant(240, problem.upper_bound);
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(240);
    for (const Eigen::VectorXd& start : {noise, pulse, full, zero}) {
      const CirculantTvResult result = solver.solve(problem, {}, start);
      expect_solved(problem, result);
      EXPECT_NEAR(result.objective, objective, 1e-10 * objective);
    }
  }
}

TEST(CirculantTv, ASolverKeepsNoStateBetweenProblems) {
  CirculantTvSolver used(240);
  for (int item = 0; item < 10; ++item) {
    const CirculantTvProblem problem = instance(item);
    CirculantTvSolver fresh(240);
    EXPECT_EQ(used.solve(problem).x, fresh.solve(problem).x);
  }
}

TEST(CirculantTv, SolvesDegenerateProblems) {
  CirculantTvProblem problem = instance(0);
  problem.upper_bound = 6;
  problem.budget = 0.0;
  EXPECT_LT(solve_circulant_tv(problem).x.sum(), 1e-12);

  problem.budget = 240.0;
  problem.kernel.setZero();
  expect_solved(problem, solve_circulant_tv(problem));

  // A kernel of zero mean leaves the level of x undetermined except by the bounds.
  problem = instance(2);
  problem.kernel.array() -= problem.kernel.mean();
  expect_solved(problem, solve_circulant_tv(problem));

  // A weight that removes all jumps.
  problem = instance(4);
  problem.total_variation_weight = 1e6;
  const CirculantTvResult flat = solve_circulant_tv(problem);
  expect_solved(problem, flat);
  EXPECT_EQ(flat.pieces, 1);
}

// A pulse at full peak that exhausts the budget exactly: none of its pieces is strictly inside.
TEST(CirculantTv, FindsTheIdealPulseOfThreeCodes) {
  constexpr int samples = 240;
  CirculantTvProblem problem;
  problem.kernel = Eigen::VectorXd::Zero(samples);
  problem.kernel.head(samples / 2).setConstant(1.0 / samples);
  problem.target = trapezoid_target(samples, 1.0 / 6);
  problem.upper_bound = 6;
  problem.budget = samples;
  problem.total_variation_weight = 1e-8;
  const CirculantTvResult result = solve_circulant_tv(problem);
  expect_solved(problem, result);
  // The weight rounds the pulse slightly.
  EXPECT_EQ((result.x.array() > 6 - 1e-5).count(), samples / 6);
  EXPECT_EQ((result.x.array() < 1e-5).count(), samples - samples / 6);
}

TEST(CirculantTv, SolvesTheShortestSignals) {
  for (const int samples : {1, 2, 3, 4, 5, 7})
    for (int item = 0; item < 20; ++item) {
      RandomStream random(9, item, static_cast<std::uint32_t>(samples));
      CirculantTvProblem problem;
      problem.kernel.resize(samples);
      problem.target.resize(samples);
      for (double& value : problem.kernel) value = random.normal();
      for (double& value : problem.target) value = 2 * random.normal();
      problem.total_variation_weight = 0.5 * random.uniform();
      problem.upper_bound = 2;
      if (item % 2 == 0) problem.budget = 0.7 * samples;
      SCOPED_TRACE("samples " + std::to_string(samples) + " item " + std::to_string(item));
      expect_solved(problem, CirculantTvSolver(samples).solve(problem));
    }
}

TEST(CirculantTv, ReportsTheUseOfTheFallback) {
  const CirculantTvProblem problem = instance(1);
  CirculantTvOptions options;
  options.max_iterations = 1;
  const CirculantTvResult alone = CirculantTvSolver(240).solve(problem, options);
  EXPECT_EQ(alone.termination, Termination::iteration_limit);
  const CirculantTvResult helped = solve_circulant_tv(problem, options);
  EXPECT_NE(helped.method, CirculantTvMethod::active_set);
  EXPECT_LT(helped.certificate, alone.certificate);
}

TEST(CirculantTv, AResultStartsAsFailure) {
  EXPECT_FALSE(CirculantTvResult{}.is_usable());
  EXPECT_EQ(CirculantTvResult{}.termination, Termination::not_run);
}

// Expects that solving `problem` fails with a message that contains all `words`.
void expect_refused(const CirculantTvProblem& problem, const std::vector<std::string>& words,
                    const CirculantTvOptions& options = {}) {
  const std::string refusal = refusal_of([&] { solve_circulant_tv(problem, options); });
  for (const std::string& word : words) EXPECT_THAT(refusal, testing::HasSubstr(word));
}

TEST(CirculantTv, NamesFieldValueAndRuleOfBadInput) {
  const auto with = [](auto change) {
    CirculantTvProblem problem = instance(0);
    change(problem);
    return problem;
  };
  expect_refused(with([](auto& p) { p.kernel[3] = NAN; }), {"kernel[3]", "nan", "finite"});
  expect_refused(with([](auto& p) { p.target[5] = INFINITY; }), {"target[5]", "inf", "finite"});
  expect_refused(with([](auto& p) { p.target.conservativeResize(239); }),
                 {"target.size()", "239", "240"});
  expect_refused({}, {"kernel.size()", "0", ">= 1"});
  for (const double weight : {0.0, -1.0})
    expect_refused(with([&](auto& p) { p.total_variation_weight = weight; }),
                   {"total_variation_weight", "> 0"});
  expect_refused(with([](auto& p) { p.upper_bound = -2; }), {"upper_bound", "-2", "> 0"});
  expect_refused(with([](auto& p) { p.budget = -3.0; }), {"budget", "-3", ">= 0"});
  expect_refused(instance(0), {"max_iterations", "-3", ">= 1"}, {.max_iterations = -3});
  expect_refused(instance(0), {"certificate_tolerance", "0", "> 0"}, {.certificate_tolerance = 0});
}

TEST(CirculantTv, RefusesStartsAndProblemsOfOtherLength) {
  const CirculantTvProblem problem = instance(0);
  CirculantTvSolver solver(240), other(120);
  EXPECT_THROW(other.solve(problem), std::invalid_argument);
  EXPECT_THROW(solver.solve(problem, {}, Eigen::VectorXd::Zero(239)), std::invalid_argument);
  EXPECT_THROW(
      solver.solve(problem, {},
                   Eigen::VectorXd::Constant(240, std::numeric_limits<double>::quiet_NaN())),
      std::invalid_argument);
  EXPECT_THROW(CirculantTvSolver(0), std::invalid_argument);
  EXPECT_THROW(certificate(problem, Eigen::VectorXd::Zero(239)), std::invalid_argument);
}

TEST(CirculantTvAdmm, AgreesWithTheActiveSetSolver) {
  for (int item = 0; item < 40; ++item) {
    RandomStream random(3, item);
    const int samples = 24 + 4 * (item % 10);
    const CirculantTvProblem problem =
        random_circulant_tv(samples, item % 3 == 0 ? 2e-4 : 2e-5, item % 2 == 1, random);
    const CirculantTvResult split = solve_circulant_tv_by_admm(problem);
    const CirculantTvResult active = CirculantTvSolver(samples).solve(problem);
    EXPECT_NEAR(split.objective, active.objective, 1e-7 * active.objective) << item;
    EXPECT_LE(certificate(problem, split.x).infeasibility, 1e-12);
    EXPECT_EQ(split.method, CirculantTvMethod::admm);
  }
}

TEST(CirculantTvAdmm, AWarmStartFromTheSolutionKeepsIt) {
  RandomStream random(4, 0);
  const CirculantTvProblem problem = random_circulant_tv(48, 2e-5, false, random);
  const CirculantTvResult active = CirculantTvSolver(48).solve(problem);
  const CirculantTvResult split = solve_circulant_tv_by_admm(problem, {}, active.x);
  EXPECT_NEAR(split.objective, active.objective, 1e-9 * active.objective);
}

TEST(CirculantTvAdmm, ReportsThatItRanOutOfSteps) {
  RandomStream random(5, 0);
  const CirculantTvProblem problem = random_circulant_tv(48, 2e-5, true, random);
  CirculantTvAdmmOptions options;
  options.max_iterations = 3;
  const CirculantTvResult result = solve_circulant_tv_by_admm(problem, options);
  EXPECT_EQ(result.termination, Termination::iteration_limit);
  EXPECT_EQ(result.iterations, 3);
  EXPECT_LE(certificate(problem, result.x).infeasibility, 1e-12);
}

TEST(CirculantTvAdmm, RefusesBadOptions) {
  const CirculantTvProblem problem = instance(5, 2e-5, 48);
  CirculantTvAdmmOptions options;
  options.tolerance = -1;
  EXPECT_THROW(solve_circulant_tv_by_admm(problem, options), std::invalid_argument);
  EXPECT_THROW(solve_circulant_tv_by_admm(problem, {}, Eigen::VectorXd::Zero(47)),
               std::invalid_argument);
}

// With A = I the solution is known in closed form.
CirculantTvProblem denoising_problem(double upper_bound, std::optional<double> budget) {
  CirculantTvProblem problem;
  RandomStream random(1, 0);
  problem.kernel = Eigen::VectorXd::Unit(60, 0);
  problem.target.resize(60);
  for (int n = 0; n < 60; ++n) problem.target[n] = random.normal() + (n < 30 ? 2 : -1);
  problem.total_variation_weight = 0.8;
  problem.upper_bound = upper_bound;
  problem.budget = budget;
  return problem;
}

Eigen::VectorXd denoised(const CirculantTvProblem& problem, double* price = nullptr) {
  TotalVariationProx prox;
  Eigen::VectorXd x;
  double ring_dual = 0;
  prox.circular(problem.target, problem.total_variation_weight, ring_dual, x);
  const double paid = project_on_box_and_budget(x, problem.upper_bound, problem.budget);
  if (price) *price = paid;
  return x;
}

TEST(CirculantTvCertificate, AcceptsTheKnownSolution) {
  for (const double upper_bound : {1.5, 100.0}) {
    const CirculantTvProblem free = denoising_problem(upper_bound, {});
    EXPECT_LT(certificate(free, denoised(free)).worst(), 1e-12);
    const CirculantTvProblem tight = denoising_problem(upper_bound, 20.0);
    double price = 0;
    const OptimalityCertificate judged = certificate(tight, denoised(tight, &price));
    EXPECT_LT(judged.worst(), 1e-11);
    EXPECT_NEAR(judged.budget_multiplier, price, 1e-10);
  }
}

TEST(CirculantTvCertificate, AcceptsAConstantIfTheWeightIsLarge) {
  CirculantTvProblem problem = denoising_problem(100, {});
  problem.total_variation_weight = 100;
  const double mean = problem.target.mean();
  EXPECT_LT(certificate(problem, Eigen::VectorXd::Constant(60, mean)).worst(), 1e-12);
  EXPECT_NEAR(certificate(problem, Eigen::VectorXd::Constant(60, mean + 0.1)).violation,
              60 * 0.1 / 100, 1e-9);
  // At a bound, only moves back into the box count.
  problem.upper_bound = 0.5 * mean;
  EXPECT_LT(certificate(problem, Eigen::VectorXd::Constant(60, 0.5 * mean)).worst(), 1e-12);
  problem.target = -problem.target;
  EXPECT_LT(certificate(problem, Eigen::VectorXd::Zero(60)).worst(), 1e-12);
  EXPECT_GT(certificate(problem, Eigen::VectorXd::Constant(60, 0.5 * mean)).violation, 0.1);
}

TEST(CirculantTvCertificate, RejectsSuboptimalPoints) {
  const CirculantTvProblem problem = denoising_problem(1.5, 20.0);
  const Eigen::VectorXd x = denoised(problem);
  for (int n = 0; n < 60; ++n)
    for (const double change : {-1e-4, 1e-4}) {
      Eigen::VectorXd moved = x;
      moved[n] += change;
      EXPECT_GT(certificate(problem, moved).worst(), 1e-6) << "sample " << n << " " << change;
    }
  EXPECT_GT(certificate(problem, 0.99 * x).violation, 1e-3);
}

TEST(CirculantTvCertificate, ReportsInfeasibility) {
  const CirculantTvProblem problem = denoising_problem(1.5, 20.0);
  EXPECT_NEAR(certificate(problem, Eigen::VectorXd::Constant(60, 1.0)).infeasibility, 2.0, 1e-12);
  EXPECT_NEAR(certificate(problem, Eigen::VectorXd::Constant(60, -0.15)).infeasibility, 0.1, 1e-12);
}

// Moving a piece or an interval may not gain more than the certificate states.
TEST(CirculantTvCertificate, BoundsTheGainOfAnyIntervalMove) {
  for (int item = 0; item < 40; ++item) {
    RandomStream random(2, item);
    const CirculantTvProblem problem = random_circulant_tv(40, 2e-5, item % 2 == 1, random);
    Eigen::VectorXd x(40);
    for (double& value : x) value = std::floor(3 * random.uniform()) / 2 * problem.upper_bound;
    CirculantTvProblem unlimited = problem;
    unlimited.budget.reset();
    const double violation = certificate(unlimited, x).violation;
    const double height = 1e-7 * problem.upper_bound;
    double best_gain = 0;
    for (int first = 0; first < 40; ++first)
      for (int length = 1; length <= 40; ++length)
        for (const int sign : {1, -1}) {
          Eigen::VectorXd moved = x;
          for (int k = 0; k < length; ++k) moved[(first + k) % 40] += sign * height;
          if (moved.minCoeff() < 0 || moved.maxCoeff() > problem.upper_bound) continue;
          best_gain = std::max(best_gain, problem.objective(x) - problem.objective(moved));
        }
    const double gain = best_gain / (height * problem.total_variation_weight);
    // An interval may span several pieces, each with its own violation.
    EXPECT_LE(gain, violation * 40 + 1e-3);
    EXPECT_GT(violation, 0.1);
  }
}

}  // namespace

}  // namespace tofsmith
