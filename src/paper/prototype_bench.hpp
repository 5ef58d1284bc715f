// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "paper/context.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith {

/// The emulated prototype with what it plays: what Figs. 10 and 11 share.
struct PrototypeBench {
  Camera camera;
  /// Redesigned Hamiltonian codes of K = 4 and 5 first, then the baselines.
  std::vector<CodeSet> codes;
  static constexpr std::size_t redesigned = 2;  ///< number of codes that are ours

  /// Filters behind which scenes are scanned.
  static const std::vector<double>& optical_densities();
  /// Light behind a filter; S is what albedo 1 returns at 1 m.
  static OperatingPoint light(double optical_density);

  /// Settings, and what the generators make of the codes.
  Section section(const std::string& scan) const;
};

/// @throws as CodeShelf::redesigned
PrototypeBench prototype_bench(const ReproduceContext& context, const Progress& progress);

}  // namespace tofsmith
