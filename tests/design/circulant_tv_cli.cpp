// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// One sub-problem as JSON on standard input, its solution as JSON on standard output: lets another
// solver, in another language, judge ours.
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tofsmith/design/circulant_tv.hpp"

namespace {

Eigen::VectorXd to_vector(const nlohmann::json& values) {
  const auto list = values.get<std::vector<double>>();
  return Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
}

}  // namespace

int main() {
  const nlohmann::json input = nlohmann::json::parse(std::cin);
  tofsmith::CirculantTvProblem problem;
  problem.kernel = to_vector(input.at("kernel"));
  problem.target = to_vector(input.at("target"));
  problem.total_variation_weight = input.at("total_variation_weight");
  problem.upper_bound = input.at("upper_bound");
  if (!input.at("budget").is_null()) problem.budget = input.at("budget").get<double>();

  const tofsmith::CirculantTvResult result = tofsmith::solve_circulant_tv(problem);
  nlohmann::json output;
  output["x"] = std::vector<double>(result.x.begin(), result.x.end());
  output["objective"] = result.objective;
  output["certificate"] = result.certificate;
  output["termination"] = std::string(name_of(result.termination));
  std::cout << output << '\n';
}
