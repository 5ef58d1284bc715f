// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/code/families.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>

#include "code/shared/family_members.hpp"
#include "code/shared/on_intervals.hpp"
#include "core/shared/decompositions.hpp"
#include "core/shared/periodic.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// First rule that prevents a conversion to rows.
std::optional<BrokenRule> not_rows(const CodeSet& code) {
  const std::string what = "code " + code.name();
  if (code.is_rows()) return std::nullopt;
  if (code.taps() != 1)
    return broken(what + " taps", code.taps(), "must be 1 for rows of one exposure");
  if (code.measurements() < 2 || code.measurements() > max_exposure_rows)
    return broken(what + " measurements", code.measurements(),
                  fmt::format("must be in [2, {}] for rows of one exposure", max_exposure_rows));
  for (int i = 0; i < code.measurements(); ++i) {
    if (!(code.modulation(i) == code.modulation(0)))
      return broken(fmt::format("{} modulation {}", what, i), "different from modulation 0",
                    "must be equal: all rows of one exposure share one modulation");
    if (code.demodulation(i).peak() == 0.0)
      return broken(fmt::format("{} demodulation {}", what, i), "all zero",
                    "must have a nonzero weight");
  }
  return std::nullopt;
}

std::optional<BrokenRule> count_misfit(const char* family, int rows, int min_count,
                                       const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  if (rows >= min_count && rows <= max_exposure_rows) return std::nullopt;
  return broken(fmt::format("rows of {}", family), rows,
                fmt::format("must be in [{}, {}]", min_count, max_exposure_rows));
}

std::optional<BrokenRule> fourier_rows_misfit(int rows, const FamilyOptions& options) {
  if (auto misfit = count_misfit("fourier", rows, 2, options)) return misfit;
  const int highest = (rows + 1) / 2;
  if (4 * highest <= options.samples) return std::nullopt;
  return broken("samples", options.samples,
                fmt::format("must be >= 4 x the highest frequency, {}", 4 * highest));
}

/// Truncated Fourier series: the shortest pulse within the peak factor, and rows cos and sin at f0,
/// 2 f0, ...; an odd last row is a cosine.
CodeSet fourier_rows(int rows, const FamilyOptions& options) {
  require(fourier_rows_misfit(rows, options));
  const int count = options.samples;
  Eigen::MatrixXd weights(count, rows);
  for (int k = 0; k < rows; ++k)
    for (int n = 0; n < count; ++n) {
      const int harmonic = k / 2 + 1;
      const double turn = 2 * std::numbers::pi * harmonic * (n + 0.5) / count;
      weights(n, k) = k % 2 == 0 ? std::cos(turn) : std::sin(turn);
    }
  return CodeSet::create_rows(fmt::format("fourier-k{}", rows),
                              rectangular_pulse(std::max(1.0 / options.peak_factor, 1.0 / count)),
                              weights);
}

std::optional<BrokenRule> histogram_rows_misfit(int rows, const FamilyOptions& options) {
  if (auto misfit = count_misfit("histogram", rows, 3, options)) return misfit;
  if (options.samples % rows == 0) return std::nullopt;
  return broken(
      "samples", options.samples,
      fmt::format("must be a multiple of {0} for histogram-k{0}, whose gates must not be rounded",
                  rows));
}

/// Histogram of K consecutive gates of equal length; the pulse is as long, or longer if the peak
/// factor requires it.
CodeSet histogram_rows(int rows, const FamilyOptions& options) {
  require(histogram_rows_misfit(rows, options));
  Eigen::MatrixXd weights(options.samples, rows);
  for (int k = 0; k < rows; ++k) {
    const double begin = static_cast<double>(k) / rows;
    weights.col(k) = Waveform::binary({{begin, begin + 1.0 / rows}}).cell_averages(options.samples);
  }
  return CodeSet::create_rows(fmt::format("histogram-k{}", rows),
                              rectangular_pulse(std::max(1.0 / options.peak_factor, 1.0 / rows)),
                              weights);
}

/// Number of harmonics that the forward model keeps.
constexpr int max_frequency = 2048;

}  // namespace

std::optional<std::string> why_no_rows(const CodeSet& code) { return text_of(not_rows(code)); }

CodeSet rows_of(const CodeSet& code) {
  require(not_rows(code));
  if (code.is_rows()) return code;
  Eigen::MatrixXd rows = code.demodulation_samples();
  for (Eigen::Index k = 0; k < rows.cols(); ++k)
    if (rows.col(k).maxCoeff() > rows.col(k).minCoeff()) rows.col(k).array() -= rows.col(k).mean();
  CodeSet result = CodeSet::create_rows(code.name(), code.modulation(0), rows);
  result.provenance = code.provenance;
  return result;
}

std::optional<BrokenRule> options_misfit(const FamilyOptions& options) {
  if (options.samples < 4) return broken("samples", options.samples, "must be >= 4");
  if (!(options.peak_factor >= 1.0))
    return broken("peak_factor", options.peak_factor, "must be >= 1");
  if (options.taps != 1 && options.taps < 3)
    return broken("taps", options.taps, "must be 1, or >= 3 for exclusive taps");
  return std::nullopt;
}

namespace {

std::optional<BrokenRule> phase_steps_misfit(int steps, int taps) {
  if (steps < 2) return broken("phase steps", steps, "must be >= 2");
  if (steps % taps != 0)
    return broken("phase steps", steps, fmt::format("must be a multiple of the {} taps", taps));
  return std::nullopt;
}

}  // namespace

std::optional<BrokenRule> multi_frequency_misfit(const std::vector<FrequencySteps>& frequencies,
                                                 const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  if (frequencies.empty()) return broken("number of frequencies", 0, "must be >= 1");
  for (const auto& [frequency, steps] : frequencies) {
    if (frequency < 1 || frequency > max_frequency)
      return broken("frequency", frequency, fmt::format("must be in [1, {}]", max_frequency));
    if (auto misfit = phase_steps_misfit(steps, options.taps)) return misfit;
  }
  return std::nullopt;
}

std::optional<BrokenRule> square_misfit(int phase_steps, const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  return phase_steps_misfit(phase_steps, options.taps);
}

std::optional<BrokenRule> pulsed_multi_frequency_misfit(int low_steps, int high_frequency,
                                                        const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  if (low_steps != 2 && low_steps != 3) return broken("low steps", low_steps, "must be 2 or 3");
  if (high_frequency < 2) return broken("high frequency", high_frequency, "must be >= 2");
  return std::nullopt;
}

std::optional<BrokenRule> gray_misfit(int bits, const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  if (bits < 3 || bits > 10) return broken("bits", bits, "must be in [3, 10]");
  return std::nullopt;
}

std::optional<BrokenRule> walk_misfit(int measurements) {
  if (measurements >= 3 && measurements <= 10) return std::nullopt;
  return broken("measurements of a Hamiltonian code", measurements, "must be in [3, 10]");
}

std::optional<BrokenRule> hamiltonian_misfit(int measurements, const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  return walk_misfit(measurements);
}

std::string pulsed_multi_frequency_name(int low_steps, int high_frequency) {
  const std::string name = fmt::format("pulsed-multifrequency-k{}", low_steps + 2);
  return high_frequency == 3 ? name : fmt::format("{}-q{}", name, high_frequency);
}

namespace {

struct Member {
  std::function<std::optional<BrokenRule>(const FamilyOptions&)> misfit;
  std::function<CodeSet(const FamilyOptions&)> build;
  bool has_phase_steps = false;  ///< three and more taps can share them
};

std::optional<int> integer(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

/// Number after `prefix`, if the name consists of both.
std::optional<int> number_after(std::string_view name, std::string_view prefix) {
  if (!name.starts_with(prefix)) return std::nullopt;
  return integer(name.substr(prefix.size()));
}

/// "1x3-7x2" -> {{1, 3}, {7, 2}}
std::optional<std::vector<FrequencySteps>> frequency_list(std::string_view text) {
  std::vector<FrequencySteps> list;
  while (!text.empty()) {
    const std::string_view entry = text.substr(0, text.find('-'));
    const std::size_t cross = entry.find('x');
    if (cross == std::string_view::npos) return std::nullopt;
    const auto frequency = integer(entry.substr(0, cross));
    const auto steps = integer(entry.substr(cross + 1));
    if (!frequency || !steps) return std::nullopt;
    list.push_back({*frequency, *steps});
    text.remove_prefix(std::min(text.size(), entry.size() + 1));
  }
  return list;
}

Member multi_frequency(const std::vector<FrequencySteps>& list) {
  return {[list](const FamilyOptions& o) { return multi_frequency_misfit(list, o); },
          [list](const FamilyOptions& o) { return multi_frequency_code(list, o); }, true};
}

Member pulsed_multi_frequency(int low_steps, int high_frequency) {
  return {[=](const FamilyOptions& o) {
            return pulsed_multi_frequency_misfit(low_steps, high_frequency, o);
          },
          [=](const FamilyOptions& o) {
            return pulsed_multi_frequency_code(low_steps, high_frequency, o);
          }};
}

std::optional<Member> member_named(std::string_view name) {
  const auto numbered = [](auto misfit, auto build, int number) {
    return Member{[=](const FamilyOptions& o) { return misfit(number, o); },
                  [=](const FamilyOptions& o) { return build(number, o); }};
  };
  if (const auto k = number_after(name, "sinusoid-k"))
    return Member{multi_frequency({{1, *k}}).misfit,
                  [k](const FamilyOptions& o) { return sinusoid_code(*k, o); }, true};
  if (const auto k = number_after(name, "square-k")) {
    Member member = numbered(square_misfit, square_code, *k);
    member.has_phase_steps = true;
    return member;
  }
  if (const auto k = number_after(name, "hamiltonian-k"))
    return numbered(hamiltonian_misfit, hamiltonian_code, *k);
  if (const auto k = number_after(name, "fourier-k"))
    return numbered(fourier_rows_misfit, fourier_rows, *k);
  if (const auto k = number_after(name, "histogram-k"))
    return numbered(histogram_rows_misfit, histogram_rows, *k);
  if (const auto k = number_after(name, "gray-k")) return numbered(gray_misfit, gray_code, *k);
  for (const int k : {4, 5}) {
    const std::string pulsed = fmt::format("pulsed-multifrequency-k{}", k);
    if (const auto q = number_after(name, pulsed + "-q")) return pulsed_multi_frequency(k - 2, *q);
    if (name == pulsed) return pulsed_multi_frequency(k - 2, 3);
  }
  if (const auto q = number_after(name, "burst-k5-q"))
    return Member{[q](const FamilyOptions& o) { return pulsed_multi_frequency_misfit(3, *q, o); },
                  [q](const FamilyOptions& o) { return burst_code(*q, o); }};
  if (name == "multifrequency-k5") {
    Member member = multi_frequency({{1, 3}, {7, 2}});
    member.build = [build = member.build](const FamilyOptions& o) {
      return build(o).renamed("multifrequency-k5");
    };
    return member;
  }
  constexpr std::string_view frequencies = "multifrequency-";
  if (name.starts_with(frequencies))
    if (const auto list = frequency_list(name.substr(frequencies.size())); list)
      return multi_frequency(*list);
  if (name == "single-ramp-k3") return Member{options_misfit, single_ramp_code};
  if (name == "double-ramp-k3") return Member{options_misfit, double_ramp_code};
  return std::nullopt;
}

std::vector<std::string> examples() {
  std::vector<std::string> names;
  for (const FamilyDescription& family : list_families()) names.push_back(family.example);
  return names;
}

BrokenRule unknown_family(std::string_view name) {
  std::vector<std::string> known = examples();
  known.insert(known.end(), {"hamiltonian-k3", "hamiltonian-k5", "sinusoid-k3", "square-k3"});
  const std::string near = nearest_word(name, known);
  return broken("code", name,
                near.empty() ? "is not a built-in family; `tofsmith codes` lists them"
                             : fmt::format("is not a built-in family; did you mean {}?", near));
}

/// Rule that a member violates, reported under the requested name.
std::optional<BrokenRule> misfit_of(std::string_view name, const Member& member,
                                    const FamilyOptions& options) {
  if (options.taps > 2 && !member.has_phase_steps)
    return broken("taps", options.taps,
                  fmt::format("this family supports one tap or two buckets; for {0} taps use "
                              "sinusoid-k{0} or square-k{0}",
                              options.taps));
  const std::optional<BrokenRule> misfit = member.misfit(options);
  if (!misfit) return std::nullopt;
  return broken("code", name,
                fmt::format("{}; `tofsmith codes` lists the families, such as {}", misfit->text(),
                            nearest_word(name, examples())));
}

/// Sinusoid within the peak factor: of mean 1, or, for taps that share the exposure, fully
/// modulated with a mean of at most 1.
Waveform sinusoid_light(int frequency, const FamilyOptions& options) {
  if (options.taps <= 2)
    return Waveform::cosine(frequency, 1.0, std::min(1.0, options.peak_factor - 1.0), 0.0);
  const double mean = std::min(1.0, options.peak_factor / 2);
  return Waveform::cosine(frequency, mean, mean, 0.0);
}

}  // namespace

std::vector<int> steps_by_tap(int steps, int taps) {
  std::vector<int> order;
  for (int exposure = 0; exposure < steps / taps; ++exposure)
    for (int tap = 0; tap < taps; ++tap) order.push_back(exposure + tap * (steps / taps));
  return order;
}

void FamilyOptions::validate() const { require(options_misfit(*this)); }

CodeSet multi_frequency_code(const std::vector<FrequencySteps>& frequencies,
                             const FamilyOptions& options) {
  require(multi_frequency_misfit(frequencies, options));
  std::vector<Waveform> modulation, demodulation;
  std::string name = "multifrequency";
  for (const auto& [frequency, steps] : frequencies) {
    name += fmt::format("-{}x{}", frequency, steps);
    for (const int step : steps_by_tap(steps, options.taps)) {
      const double phase = 2 * std::numbers::pi * step / (steps == 2 ? 4 : steps);
      const double gain = 1.0 / std::max(2, options.taps);
      demodulation.push_back(Waveform::cosine(frequency, gain, gain, phase));
    }
    modulation.insert(modulation.end(), static_cast<std::size_t>(steps / options.taps),
                      sinusoid_light(frequency, options));
  }
  return CodeSet::create(name, options.samples, options.taps, std::move(modulation),
                         std::move(demodulation));
}

CodeSet sinusoid_code(int phase_steps, const FamilyOptions& options) {
  return multi_frequency_code({{1, phase_steps}}, options)
      .renamed(fmt::format("sinusoid-k{}", phase_steps));
}

std::vector<FamilyDescription> list_families() {
  return {
      {"sinusoid-kK", "sinusoid-k4", "sinusoids, K phase steps"},
      {"square-kK", "square-k4", "square waves, K phase steps"},
      {"hamiltonian-kK", "hamiltonian-k4", "Hamiltonian walk on the K-cube, K = 3 to 10"},
      {"multifrequency-k5", "multifrequency-k5", "sinusoids: 3 steps at f0 and 2 at 7 f0"},
      {"multifrequency-FxS-..", "multifrequency-1x4-5x4", "sinusoids: S steps at F x f0, ..."},
      {"pulsed-multifrequency-k5", "pulsed-multifrequency-k5",
       "pulses and squares: 3 steps at f0, a quadrature pair at 3 f0"},
      {"pulsed-multifrequency-k5-qQ", "pulsed-multifrequency-k5-q5",
       "pulses and squares: 3 steps at f0, a quadrature pair at Q f0"},
      {"pulsed-multifrequency-k4", "pulsed-multifrequency-k4",
       "quadrature pairs at f0 and 3 f0 (or Q f0 with -qQ), for two buckets"},
      {"burst-k5-qQ", "burst-k5-q5",
       "the same burst of pulses at Q f0 in every exposure: 3 steps at f0, a pair at Q f0"},
      {"gray-kK", "gray-k4", "binary-reflected Gray code of 2^K cells, K = 3 to 10"},
      {"single-ramp-k3", "single-ramp-k3", "rising ramp, open gate, background"},
      {"double-ramp-k3", "double-ramp-k3", "rising ramp, falling ramp, background"},
      {"fourier-kK", "fourier-k8", "rows of one exposure: cosines and sines at f0, 2 f0, ..."},
      {"histogram-kK", "histogram-k8", "rows of one exposure: K time gates, a coarse histogram"},
  };
}

std::vector<std::string> family_members(const FamilyOptions& options, int highest_frequency) {
  constexpr int min_measurements = 3, max_measurements = 10, max_steps = 4;
  std::vector<std::string> names = {"single-ramp-k3", "double-ramp-k3", "multifrequency-k5"};
  for (int k = min_measurements; k <= max_measurements; ++k)
    for (const char* family : {"sinusoid", "square", "hamiltonian", "gray"})
      names.push_back(fmt::format("{}-k{}", family, k));
  for (int q = 2; q <= highest_frequency; ++q) {
    for (const int low_steps : {2, 3}) names.push_back(pulsed_multi_frequency_name(low_steps, q));
    names.push_back(fmt::format("burst-k5-q{}", q));
    for (int low_steps = 2; low_steps <= max_steps; ++low_steps)
      for (int steps = 2; steps <= max_steps; ++steps)
        if (q != 7 || low_steps != 3 || steps != 2)  // this code has its own name
          names.push_back(fmt::format("multifrequency-1x{}-{}x{}", low_steps, q, steps));
  }
  std::erase_if(names,
                [&](const std::string& name) { return why_no_family(name, options).has_value(); });
  return names;
}

bool is_family(std::string_view name) { return member_named(name).has_value(); }

std::optional<std::string> why_no_family(std::string_view name, const FamilyOptions& options) {
  const auto member = member_named(name);
  return text_of(member ? misfit_of(name, *member, options) : unknown_family(name));
}

CodeSet make_family(std::string_view name, const FamilyOptions& options) {
  const auto member = member_named(name);
  require(member ? misfit_of(name, *member, options) : unknown_family(name));
  CodeSet code = member->build(options);
  code.provenance.method = "family";
  return code;
}

namespace {
Eigen::MatrixXd about_mean(const Eigen::MatrixXd& table) {
  require(table.rows() >= 2, "rows of the correlation table", table.rows(), "must be >= 2");
  return table.rowwise() - table.colwise().mean();
}
}  // namespace

double coding_curve_length(const Eigen::MatrixXd& table) {
  double length = 0.0;
  for (Eigen::Index n = 0; n < table.rows(); ++n)
    length += (table.row((n + 1) % table.rows()) - table.row(n)).norm();
  return length;
}

int harmonics_used(const Eigen::MatrixXd& table, double share) {
  require(share > 0.0 && share <= 1.0, "share", share, "must be in (0, 1]");
  const PeriodicTransform transform(static_cast<int>(table.rows()));
  Eigen::VectorXd energy = Eigen::VectorXd::Zero(transform.coefficients());
  Eigen::VectorXcd spectrum;
  for (Eigen::Index k = 0; k < table.cols(); ++k) {
    transform.forward(table.col(k), spectrum);
    energy += spectrum.cwiseAbs2();
  }
  energy[0] = 0.0;
  const double total = energy.sum();
  double sum = 0.0;
  for (int h = 1; h < energy.size(); ++h) {
    sum += energy[h];
    if (sum >= share * total) return h;
  }
  return static_cast<int>(energy.size()) - 1;
}

Eigen::MatrixXd coding_curve_in_space(const Eigen::MatrixXd& table) {
  const Eigen::MatrixXd centred = about_mean(table);
  const ThinSvd svd = thin_svd(centred);
  const Eigen::Index axes = std::min<Eigen::Index>(3, centred.cols());
  Eigen::MatrixXd points = Eigen::MatrixXd::Zero(table.rows(), 3);
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    // The remainder beyond the rank of the curve is rounding error.
    if (svd.values[axis] < 1e-9 * svd.values[0]) break;
    points.col(axis) = centred * svd.v.col(axis);
  }
  return points;
}

int coding_curve_rank(const Eigen::MatrixXd& table, double tolerance) {
  const Eigen::VectorXd values = thin_svd(about_mean(table)).values;
  return static_cast<int>((values.array() > tolerance * std::max(values[0], 1e-300)).count());
}

}  // namespace tofsmith
