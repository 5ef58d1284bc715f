// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/chips/pair_choice.hpp"

#include <limits>
#include <map>

#include "camera/shared/depth_prior.hpp"
#include "core/shared/random.hpp"
#include "design/judge.hpp"

namespace tofsmith {

namespace {

constexpr std::uint32_t random_choices = 8;

double search_error_m(const CodeSet& code, const Camera& camera, const EvaluateOptions& options,
                      bool at_best_rotation) {
  if (why_no_depth(code, camera)) return std::numeric_limits<double>::infinity();
  if (at_best_rotation && !DepthPrior(camera).is_uniform()) {
    const BestRotation best = best_rotation(code, camera, options);
    return best.linear_geometric_mean_m[static_cast<std::size_t>(best.rotation_bin)];
  }
  const DepthErrorKind kind = at_best_rotation ? DepthErrorKind::circular : camera.operating.error;
  return geometric_mean_error_m(evaluate(code, camera, options), kind);
}

template <typename Error>
PairChoice bettered(PairChoice best, const std::vector<Factorization>& factorizations,
                    const Error& error_of, const Progress& progress) {
  constexpr int rounds = 3;
  bool improved = true;
  for (int round = 0; improved && round < rounds; ++round) {
    improved = false;
    for (std::size_t k = 0; k < best.size(); ++k) {
      const double done = round + static_cast<double>(k) / static_cast<double>(best.size());
      for (std::size_t i = 0; i < factorizations[k].candidates.size(); ++i) {
        report(progress, done / rounds, "selecting pairs by depth error");
        PairChoice trial = best;
        trial[k] = i;
        if (error_of(trial) >= error_of(best)) continue;
        best = trial;
        improved = true;
      }
    }
  }
  return best;
}

/// Returns 0 if there is no naive pair.
std::size_t naive_index(const Factorization& factorization) {
  for (std::size_t i = 0; i < factorization.candidates.size(); ++i)
    if (factorization.candidates[i].start == "naive") return i;
  return 0;
}

}  // namespace

CodeSet assemble(const std::string& name, const std::vector<Factorization>& factorizations,
                 const PairChoice& choice, const Camera& camera) {
  std::vector<Waveform> modulation, demodulation;
  for (std::size_t k = 0; k < choice.size(); ++k) {
    const WaveformPair& pair = factorizations[k].candidates[choice[k]].pair;
    modulation.push_back(pair.modulation);
    demodulation.push_back(pair.demodulation);
  }
  const CodeSet code =
      CodeSet::create(name, camera.samples, 1, std::move(modulation), std::move(demodulation));
  return camera.sensor.taps == 2 ? code.with_two_buckets() : code;
}

PairChoice choose_by_depth_error(const std::vector<Factorization>& factorizations,
                                 const Camera& camera, const EvaluateOptions& options,
                                 bool at_best_rotation, const Progress& progress) {
  std::map<PairChoice, double> known;
  const auto error_of = [&](const PairChoice& choice) {
    const auto [entry, fresh] = known.try_emplace(choice, 0.0);
    if (fresh)
      entry->second = search_error_m(assemble("candidate", factorizations, choice, camera), camera,
                                     options, at_best_rotation);
    return entry->second;
  };

  // Individually good pairs need not be the best combination.
  std::vector<PairChoice> starts{PairChoice(factorizations.size(), 0), {}};
  for (const Factorization& f : factorizations) starts[1].push_back(naive_index(f));
  for (std::uint32_t i = 0; i < random_choices; ++i) {
    RandomStream random(options.seed, 0xc401ce, i);
    PairChoice& start = starts.emplace_back();
    for (const Factorization& f : factorizations)
      start.push_back(
          static_cast<std::size_t>(random.uniform() * static_cast<double>(f.candidates.size())));
  }
  const ProgressParts parts(progress, starts.size());
  PairChoice best = starts[0];
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const PairChoice found = bettered(starts[i], factorizations, error_of, parts[i]);
    if (error_of(found) < error_of(best)) best = found;
  }
  return best;
}

}  // namespace tofsmith
