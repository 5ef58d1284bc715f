// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Compares the gain of unequal exposure times, by trials, with the gain that the Cramer-Rao bound
// predicts: for given codes with the best shares by the bound, decoded by correlation (zncc) and by
// maximum likelihood (ml), with the shares of the design (which include gradients of the soft
// decoder), and for new designs whose waveforms and shares were optimized together.
//
//   benchmark_exposure_times [TRIALS]
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "asked_figures.hpp"
#include "design/exposure_shares.hpp"
#include "design/exposure_split.hpp"
#include "design/frequencies/square_error.hpp"
#include "tofsmith/design/design.hpp"

namespace {

using namespace tofsmith;

struct Setting {
  std::string name;
  Camera camera;
  bool is_bright;  ///< the error is close to the bound
  std::vector<CodeSet> codes;
};

Camera at_light(Camera camera, std::vector<double> signal, std::vector<double> ambient) {
  camera.operating.signal_e_per_s = std::move(signal);
  camera.operating.ambient_e_per_s = std::move(ambient);
  camera.operating.error = DepthErrorKind::circular;
  return camera;
}

Camera paper() {
  Camera camera = built_in_camera("paper-10f0");
  camera.operating.error = DepthErrorKind::circular;
  return camera;
}

std::vector<CodeSet> families(const Camera& camera, const std::vector<std::string>& names) {
  std::vector<CodeSet> codes;
  for (const std::string& name : names) codes.push_back(build_family(name, camera));
  return codes;
}

/// 20 and 100 MHz with equal times.
std::vector<CodeSet> square_codes(const Camera& camera) {
  std::vector<CodeSet> codes;
  for (const int phases : {2, 3, 4})
    codes.push_back(
        to_code_set({.duty = 0.5, .tones = {{5, phases, 0.5}, {1, phases, 0.5}}}, camera));
  return codes;
}

std::vector<Setting> settings() {
  const std::vector<std::string> standard = {"hamiltonian-k4", "hamiltonian-k5",
                                             "pulsed-multifrequency-k5", "square-k4",
                                             "multifrequency-1x4-7x4"};
  const Camera dim = paper(), bright = at_light(paper(), {1e6, 1e7}, {1e5});
  Camera chip = built_in_camera("mlx75027");
  chip.light.square->frequencies_hz = {{20e6, 100e6}};
  const Camera bright_chip = at_light(chip, {1e8}, {1e7});
  return {{"paper-10f0, S = 1e6 and 1e7, A = 1e5 e/s", bright, true, families(bright, standard)},
          {"paper-10f0, its 25 light levels", dim, false, families(dim, standard)},
          {"mlx75027, S = 1e8, A = 1e7 e/s", bright_chip, true, square_codes(bright_chip)},
          {"mlx75027, its light levels", chip, false, square_codes(chip)}};
}

double error_m(const CodeSet& code, const Camera& camera, std::int64_t trials,
               DecodeMethod method = DecodeMethod::zncc) {
  return evaluate(code, camera, {.trials = trials, .seed = 77, .method = method, .bounds = false})
      .of(camera.operating.measure())
      .geometric_mean_m.value;
}

CodeSet with_shares(const CodeSet& code, const Eigen::VectorXd& shares) {
  return code.with_exposure_shares({shares.begin(), shares.end()});
}

std::string percent(const Eigen::VectorXd& shares) {
  std::string text;
  for (const double share : shares)
    text += fmt::format("{}{:.0f}", text.empty() ? "" : " ", 100 * share);
  return text;
}

void print_row(const std::string& name, double predicted, std::optional<double> zncc,
               std::optional<double> ml, double designed, const Eigen::VectorXd& by_bound,
               const Eigen::VectorXd& by_design) {
  const auto text = [](std::optional<double> gain) {
    return gain ? fmt::format("{:.3f}", *gain) : std::string();
  };
  fmt::print("{:<28}{:>8.3f}{:>8}{:>8}{:>9.3f}   {}; {}\n", name, predicted, text(zncc), text(ml),
             designed, percent(by_bound), percent(by_design));
  std::fflush(stdout);
}

void ask(const Setting& its, const std::string& name, double gain, double predicted,
         benchmarks::AskedFigures& asked) {
  if (its.is_bright)
    asked.at_least("gain of " + name + " / gain by the bound", gain / predicted, 0.95);
  asked.at_least("gain of " + name, gain, 0.998);
}

void measure_given(const Setting& its, std::int64_t trials, benchmarks::AskedFigures& asked) {
  for (const CodeSet& code : its.codes) {
    const ExposureBound bound(code, its.camera);
    const Eigen::VectorXd shares = bound.best_shares();
    const double predicted = bound.gain(shares);
    const CodeSet by_bound = with_shares(code, shares);
    const double equal_m = error_m(code, its.camera, trials);
    const double zncc = equal_m / error_m(by_bound, its.camera, trials);
    const double ml = error_m(code, its.camera, trials, DecodeMethod::ml) /
                      error_m(by_bound, its.camera, trials, DecodeMethod::ml);
    const CodeSet split = with_split_exposures(code, its.camera, {});
    const double designed = equal_m / error_m(split, its.camera, trials);
    print_row(code.name(), predicted, zncc, ml, designed, shares, shares_of(split));
    ask(its, code.name(), designed, predicted, asked);
  }
}

/// Returns the best designed code by the error that the camera selects.
CodeSet best_design(const Camera& camera, const DesignOptions& options) {
  const DesignResult result = design(camera, options);
  const Candidate* best = nullptr;
  const auto error_of = [&](const Candidate& c) {
    return c.error.of(camera.operating.measure()).geometric_mean_m.value;
  };
  for (const Candidate& c : result.candidates)
    if (c.is_designed() && (!best || error_of(c) < error_of(*best))) best = &c;
  return best->code;
}

/// Designs with equal and with free exposure times.
void measure_designed(const Setting& its, DesignMethod method, int exposures, std::int64_t trials,
                      benchmarks::AskedFigures& asked) {
  DesignOptions options{.method = method, .exposures = {exposures}};
  options.baselines = std::vector<std::string>{"square-k4"};
  const CodeSet equal = best_design(its.camera, options);
  options.split_exposures = true;
  const CodeSet split = best_design(its.camera, options);
  const ExposureBound bound(equal, its.camera);
  const double predicted = bound.gain(bound.best_shares());
  const double gain = error_m(equal, its.camera, trials) / error_m(split, its.camera, trials);
  print_row(equal.name(), predicted, {}, {}, gain, bound.best_shares(), shares_of(split));
  ask(its, equal.name(), gain, predicted, asked);
}

/// The design method `frequencies` splits the time itself; the shares of other codes, from its
/// frequencies with equal times, are compared with this split.
void measure_frequencies(const Setting& its, std::int64_t trials, benchmarks::AskedFigures& asked) {
  const CodeSet found = best_design(its.camera, {.method = DesignMethod::frequencies});
  const CodeSet equal = found.with_exposure_shares({});
  const CodeSet split = with_split_exposures(equal, its.camera, {});
  const ExposureBound bound(equal, its.camera);
  const double predicted = bound.gain(bound.best_shares());
  const double equal_m = error_m(equal, its.camera, trials);
  const double gain = equal_m / error_m(found, its.camera, trials);
  print_row(found.name() + " (own)", predicted, {}, {}, gain, bound.best_shares(),
            shares_of(found));
  print_row(found.name(), predicted, {}, {}, equal_m / error_m(split, its.camera, trials),
            bound.best_shares(), shares_of(split));
  ask(its, found.name() + " by method frequencies", gain, predicted, asked);
}

}  // namespace

int main(int argc, char** argv) {
  const std::int64_t trials = argc > 1 ? std::atoll(argv[1]) : 20000;
  benchmarks::AskedFigures asked;
  for (const Setting& its : settings()) {
    fmt::print("\n{}\n{:<28}{:>8}{:>8}{:>8}{:>9}   shares (%) by bound; by design\n", its.name,
               "code", "bound", "zncc", "ml", "design");
    measure_given(its, trials, asked);
    if (its.camera.name != "paper-10f0") {
      measure_frequencies(its, trials, asked);
      continue;
    }
    for (const int exposures : {4, 5})
      measure_designed(its, DesignMethod::optimize, exposures, trials, asked);
    measure_designed(its, DesignMethod::factorize, 4, trials, asked);
  }
  asked.print();
}
