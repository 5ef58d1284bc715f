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

#include "code/row_families.hpp"
#include "code/shared/family_rules.hpp"
#include "code/shared/hamiltonian.hpp"
#include "code/shared/ramp.hpp"
#include "code/square.hpp"

namespace tofsmith {
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

}  // namespace tofsmith
