// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "temporary_directory.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

inline WorkList small_list(const std::string& peaks = "12, 15", const std::string& more = "") {
  return WorkList(parse_sweep_toml(
      "set = [\"samples=24\"]\ncodes = [\"sinusoid-k4\", \"hamiltonian-k3\"]\ntrials = 16\n" +
      more + "[[axis]]\nkey = \"light.peak_factor\"\nvalues = [" + peaks +
      "]\n[[axis]]\nkey = \"signal_e_per_s\"\nfrom = 1e3\nto = 1e5\ncount = 3\n"
      "[[axis]]\nkey = \"ambient_e_per_s\"\nvalues = [1e4]\n"));
}

/// Returns the content of the store.
inline std::string swept(const std::filesystem::path& path, const WorkList& list,
                         std::int64_t* computed = nullptr, const SweepRunOptions& options = {}) {
  const std::vector<std::string> keys = list.keys();
  SweepStore store = SweepStore::open(path);
  const SweepRun run = run_sweep(list, keys, store, options);
  EXPECT_TRUE(run.failures.empty()) << run.failures.front();
  if (computed != nullptr) *computed = run.computed;
  return sweep_json(list, sweep_results(list, keys, store), store.target());
}

}  // namespace tofsmith
