// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/circulant_tv_admm.hpp"

#include <gtest/gtest.h>

#include "circulant_tv_instances.hpp"
#include "design/circulant_tv/circulant_tv_certificate.hpp"

namespace tofsmith {
namespace {

TEST(CirculantTvAdmm, AgreesWithTheActiveSetSolver) {
  for (int item = 0; item < 40; ++item) {
    RandomStream random(3, item);
    const int samples = 24 + 4 * (item % 10);
    const CirculantTvProblem problem =
        test::random_circulant_tv({samples, item % 3 == 0 ? 2e-4 : 2e-5, item % 2 == 1}, random);
    const CirculantTvResult split = solve_circulant_tv_by_admm(problem);
    const CirculantTvResult active = CirculantTvSolver(samples).solve(problem);
    EXPECT_NEAR(split.objective, active.objective, 1e-7 * active.objective) << split.brief();
    EXPECT_LE(certificate(problem, split.x).infeasibility, 1e-12);
    EXPECT_EQ(split.method, CirculantTvMethod::admm);
  }
}

TEST(CirculantTvAdmm, AWarmStartFromTheSolutionKeepsIt) {
  RandomStream random(4, 0);
  const CirculantTvProblem problem = test::random_circulant_tv({48, 2e-5, false}, random);
  const CirculantTvResult active = CirculantTvSolver(48).solve(problem);
  const CirculantTvResult split = solve_circulant_tv_by_admm(problem, {}, active.x);
  EXPECT_NEAR(split.objective, active.objective, 1e-9 * active.objective);
}

TEST(CirculantTvAdmm, ReportsThatItRanOutOfSteps) {
  RandomStream random(5, 0);
  const CirculantTvProblem problem = test::random_circulant_tv({48, 2e-5, true}, random);
  CirculantTvAdmmOptions options;
  options.max_iterations = 3;
  const CirculantTvResult result = solve_circulant_tv_by_admm(problem, options);
  EXPECT_EQ(result.termination, Termination::iteration_limit);
  EXPECT_EQ(result.iterations, 3);
  EXPECT_LE(certificate(problem, result.x).infeasibility, 1e-12);
}

TEST(CirculantTvAdmm, RefusesBadOptions) {
  RandomStream random(6, 0);
  const CirculantTvProblem problem = test::random_circulant_tv({48, 2e-5, true}, random);
  CirculantTvAdmmOptions options;
  options.tolerance = -1;
  EXPECT_THROW(solve_circulant_tv_by_admm(problem, options), std::invalid_argument);
  EXPECT_THROW(solve_circulant_tv_by_admm(problem, {}, Eigen::VectorXd::Zero(47)),
               std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
