// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/code/families.hpp"

#include <fmt/format.h>

#include <charconv>
#include <functional>
#include <optional>

#include "tofsmith/code/hamiltonian.hpp"
#include "tofsmith/code/ramp.hpp"
#include "tofsmith/code/square.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

using Builder = std::function<CodeSet(const FamilyOptions&)>;

std::optional<int> integer(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

/// The number behind `prefix`, when the name is the prefix and a number.
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

std::optional<Builder> builder_for(std::string_view name) {
  if (const auto k = number_after(name, "sinusoid-k"))
    return [k](const FamilyOptions& o) { return sinusoid_code(*k, o); };
  if (const auto k = number_after(name, "square-k"))
    return [k](const FamilyOptions& o) { return square_code(*k, o); };
  if (const auto k = number_after(name, "hamiltonian-k"))
    return [k](const FamilyOptions& o) { return hamiltonian_code(*k, o); };
  if (const auto k = number_after(name, "gray-k"))
    return [k](const FamilyOptions& o) { return gray_code(*k, o); };
  for (const int k : {4, 5}) {
    const std::string pulsed = fmt::format("pulsed-multifrequency-k{}", k);
    if (const auto q = number_after(name, pulsed + "-q"))
      return [k, q](const FamilyOptions& o) { return pulsed_multi_frequency_code(k - 2, *q, o); };
    if (name == pulsed)
      return [k](const FamilyOptions& o) { return pulsed_multi_frequency_code(k - 2, 3, o); };
  }
  if (name == "multifrequency-k5")
    return [](const FamilyOptions& o) {
      return multi_frequency_code({{1, 3}, {7, 2}}, o).renamed("multifrequency-k5");
    };
  constexpr std::string_view multi_frequency = "multifrequency-";
  if (name.starts_with(multi_frequency))
    if (const auto list = frequency_list(name.substr(multi_frequency.size())); list)
      return [list](const FamilyOptions& o) { return multi_frequency_code(*list, o); };
  if (name == "single-ramp-k3") return single_ramp_code;
  if (name == "double-ramp-k3") return double_ramp_code;
  return std::nullopt;
}

/// The name that is built of each family.
std::vector<std::string> examples() {
  std::vector<std::string> names;
  for (const FamilyDescription& family : list_families()) names.push_back(family.example);
  return names;
}

/// What the family refuses, a number out of its range or a grid that it does not fit, under the
/// name that was asked for.
CodeSet built(std::string_view name, const Builder& builder, const FamilyOptions& options) {
  try {
    return builder(options);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("code = {}; {}; `tofsmith codes` lists what there is, such as {}", name,
                    error.what(), nearest_word(name, examples())));
  }
}

}  // namespace

std::vector<FamilyDescription> list_families() {
  return {
      {"sinusoid-kK", "sinusoid-k4", "sinusoids, K phase steps"},
      {"square-kK", "square-k4", "square waves, K phase steps"},
      {"hamiltonian-kK", "hamiltonian-k4", "Hamiltonian walk on the K-cube, K = 3 .. 10"},
      {"multifrequency-k5", "multifrequency-k5", "sinusoids: 3 steps at f0 and 2 at 7 f0"},
      {"multifrequency-FxS-..", "multifrequency-1x4-5x4", "sinusoids: S steps at F x f0, .."},
      {"pulsed-multifrequency-k5", "pulsed-multifrequency-k5",
       "pulses and squares: 3 steps at f0, a quadrature pair at 3 f0"},
      {"pulsed-multifrequency-k5-qQ", "pulsed-multifrequency-k5-q5",
       "the same with the pair at Q f0"},
      {"pulsed-multifrequency-k4", "pulsed-multifrequency-k4",
       "quadrature pairs at f0 and 3 f0, for two buckets; -qQ as above"},
      {"gray-kK", "gray-k4", "binary-reflected Gray code of 2^K cells, K = 3 .. 10"},
      {"single-ramp-k3", "single-ramp-k3", "rising ramp, open gate, background"},
      {"double-ramp-k3", "double-ramp-k3", "rising ramp, falling ramp, background"},
  };
}

bool is_family(std::string_view name) { return builder_for(name).has_value(); }

CodeSet make_family(std::string_view name, const FamilyOptions& options) {
  if (const auto builder = builder_for(name)) {
    CodeSet code = built(name, *builder, options);
    code.provenance.method = "family";
    return code;
  }
  std::vector<std::string> known = examples();
  known.insert(known.end(), {"hamiltonian-k3", "hamiltonian-k5", "sinusoid-k3", "square-k3"});
  const std::string near = nearest_word(name, known);
  reject("code", name,
         near.empty() ? "is not a built-in family; `tofsmith codes` lists them"
                      : fmt::format("is not a built-in family; did you mean {}?", near));
}

}  // namespace tofsmith
