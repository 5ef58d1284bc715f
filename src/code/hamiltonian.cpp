// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "code/shared/family_members.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/shared/random.hpp"

namespace tofsmith {

namespace {

/// Code of a published walk: lengths of its alternating on and off runs, and the start of the
/// first.
struct CodeRuns {
  int shift;
  std::vector<int> runs;
};

std::vector<CodeRuns> published_runs(int measurements) {
  switch (measurements) {
    case 3:
      return {{0, {3, 3}}, {2, {3, 3}}, {4, {3, 3}}};
    case 4:
      return {{5, {6, 6}}, {2, {6, 6}}, {0, {3, 4, 3, 2}}, {4, {2, 3, 4, 3}}};
    case 5:
      return {{15, {15, 15}},
              {7, {15, 15}},
              {3, {8, 8, 7, 7}},
              {1, {4, 4, 4, 4, 3, 4, 4, 3}},
              {4, {2, 2, 2, 2, 2, 2, 2, 3, 2, 2, 2, 2, 3, 2}}};
    default:
      return {};
  }
}

std::vector<std::uint32_t> walk_of_runs(const std::vector<CodeRuns>& codes, int length) {
  std::vector<std::uint32_t> walk(static_cast<std::size_t>(length), 0u);
  for (std::size_t k = 0; k < codes.size(); ++k) {
    int position = codes[k].shift;
    bool on = true;
    for (const int run : codes[k].runs) {
      for (int i = 0; i < run; ++i, ++position)
        if (on) walk[static_cast<std::size_t>(position % length)] |= 1u << k;
      on = !on;
    }
  }
  return walk;
}

/// Excludes all-zeros, all-ones and, for even K, one complementary pair of odd weight, which
/// balances the bipartite cube and keeps every duty at one half.
std::vector<bool> usable_vertices(int measurements) {
  const std::uint32_t all = (1u << measurements) - 1;
  std::vector<bool> usable(std::size_t{1} << measurements, true);
  usable[0] = usable[all] = false;
  if (measurements % 2 == 0) usable[1] = usable[all ^ 1u] = false;
  return usable;
}

/// Posa's rotation-extension search for a Hamiltonian cycle: extends the path, or closes it on
/// itself and reverses the tail.
std::optional<std::vector<std::uint32_t>> search_cycle(int measurements, std::uint64_t attempt) {
  const std::vector<bool> usable = usable_vertices(measurements);
  const auto length = static_cast<std::size_t>(std::count(usable.begin(), usable.end(), true));
  constexpr int absent = -1;
  std::vector<int> position(usable.size(), absent);
  std::vector<std::uint32_t> path{2u};
  position[2] = 0;
  RandomStream random(0, static_cast<std::uint64_t>(measurements),
                      static_cast<std::uint32_t>(attempt));
  const auto single_bit = [](std::uint32_t x) { return x != 0 && (x & (x - 1)) == 0; };
  for (std::size_t step = 0; step < 400 * length; ++step) {
    const std::uint32_t tail = path.back();
    if (path.size() == length && single_bit(tail ^ path.front())) return path;
    std::vector<std::uint32_t> unused, visited;
    for (int bit = 0; bit < measurements; ++bit) {
      const std::uint32_t next = tail ^ (1u << bit);
      if (!usable[next]) continue;
      (position[next] == absent ? unused : visited).push_back(next);
    }
    const auto pick = [&](const std::vector<std::uint32_t>& from) {
      return from[random() % from.size()];
    };
    if (!unused.empty()) {
      path.push_back(pick(unused));
      position[path.back()] = static_cast<int>(path.size()) - 1;
    } else {
      const int pivot = position[pick(visited)];
      std::reverse(path.begin() + pivot + 1, path.end());
      for (std::size_t i = static_cast<std::size_t>(pivot) + 1; i < path.size(); ++i)
        position[path[i]] = static_cast<int>(i);
    }
  }
  return std::nullopt;
}

}  // namespace

int hamiltonian_length(int measurements) {
  require(walk_misfit(measurements));
  return (1 << measurements) - (measurements % 2 == 0 ? 4 : 2);
}

std::vector<std::uint32_t> hamiltonian_walk(int measurements) {
  require(walk_misfit(measurements));
  if (measurements <= 5)
    return walk_of_runs(published_runs(measurements), hamiltonian_length(measurements));
  for (std::uint64_t attempt = 0;; ++attempt)
    if (auto cycle = search_cycle(measurements, attempt)) return *cycle;
}

CodeSet hamiltonian_code(int measurements, const FamilyOptions& options) {
  require(hamiltonian_misfit(measurements, options));
  const std::vector<std::uint32_t> walk = hamiltonian_walk(measurements);
  const int length = static_cast<int>(walk.size());
  const Waveform pulse =
      rectangular_pulse(std::max(1.0 / options.peak_factor, 1.0 / static_cast<double>(length)));
  std::vector<Waveform> demodulation;
  for (int k = 0; k < measurements; ++k) {
    Eigen::VectorXd on(length);
    for (int n = 0; n < length; ++n) on[n] = (walk[static_cast<std::size_t>(n)] >> k) & 1u;
    demodulation.push_back(Waveform::binary_from_samples(on, 1.0));
  }
  return CodeSet::create(fmt::format("hamiltonian-k{}", measurements), options.samples, 1,
                         std::vector<Waveform>(static_cast<std::size_t>(measurements), pulse),
                         std::move(demodulation));
}

}  // namespace tofsmith
