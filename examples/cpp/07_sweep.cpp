// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Computes depth errors of several cameras and codes. A second run continues from the store.
#include <cstdio>

#include "tofsmith/sweep/run_sweep.hpp"

constexpr const char* sweep = R"(
camera = "paper-10f0"
set = ["samples=120"]
codes = ["square-k4", "hamiltonian-k4"]
trials = 100

[[axis]]
key = "light.peak_factor"
values = [5, 10, 15]
)";

int main() {
  using namespace tofsmith;
  const WorkList list(parse_sweep_toml(sweep));
  const std::vector<std::string> keys = list.keys();
  SweepStore store = SweepStore::open("sweep.sqlite");
  run_sweep(list, keys, store);
  const std::vector<SweepResult> results = sweep_results(list, keys, store);
  std::size_t rows = 0;
  for (const SweepResult& result : results) rows += result.error.points.size();
  std::printf("%zu of %lld items, %zu rows\n", results.size(), static_cast<long long>(list.size()),
              rows);
  for (const SweepResult& result : results)
    if (list.code_name(result.item) == "hamiltonian-k4")
      std::printf("p = %.0f: %.0f mm\n", list.item(result.item).camera.light.peak_factor,
                  1e3 * result.error.linear.mean_m.value);
}
