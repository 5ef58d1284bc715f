// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/table_reader.hpp"
#include "sweep/sweep_axis.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/read_file.hpp"
#include "tofsmith/sweep/sweep_spec.hpp"

namespace tofsmith {

namespace {

using MethodWord = std::pair<std::string_view, DecodeMethod>;
using WeightsWord = std::pair<std::string_view, UnwrapWeights>;
using CombineWord = std::pair<std::string_view, SweepCombination>;
constexpr std::array weights = {WeightsWord{"variance", UnwrapWeights::variance},
                                WeightsWord{"frequency", UnwrapWeights::frequency}};
constexpr std::array combinations = {CombineWord{"product", SweepCombination::product},
                                     CombineWord{"zip", SweepCombination::zip}};

void read_options(TableReader& table, EvaluateOptions& options) {
  auto trials = static_cast<std::uint64_t>(options.trials);
  auto most_trials = static_cast<std::uint64_t>(options.most_trials);
  std::array<MethodWord, all_decode_methods.size()> methods;
  std::ranges::transform(all_decode_methods, methods.begin(), [](DecodeMethod method) {
    return MethodWord{name_of(method), method};
  });
  table.choice("method", options.method, Choices<DecodeMethod>(methods));
  table.choice("unwrap_weights", options.unwrap_weights, Choices<UnwrapWeights>(weights));
  table.value("trials", trials);
  table.value("target_standard_error", options.target_standard_error);
  table.value("most_trials", most_trials);
  table.value("seed", options.seed);
  table.value("outlier_threshold_m", options.outlier_threshold_m);
  options.trials = static_cast<std::int64_t>(trials);
  options.most_trials = static_cast<std::int64_t>(most_trials);
  try {
    options.validate();
  } catch (const InvalidArgument& error) {
    table.fail(error.field(), error.what());
  }
}

/// `codes = [..]` is an axis that is crossed with all others.
void read_codes(TableReader& table, SweepSpec& spec) {
  table.value("code", spec.code);
  std::vector<SettingValue> codes;
  table.value("codes", codes);
  if (!table.contains("codes")) return;
  if (table.contains("code")) table.refuse({"code"}, "no codes beside it");
  if (codes.empty()) table.fail("codes", "found an empty list; expected at least one code");
  spec.axes.push_back({"code", std::move(codes), table.place_of("codes"), true});
}

bool has_axis(const SweepSpec& spec, std::string_view key) {
  return std::ranges::any_of(spec.axes, [&](const SweepAxis& axis) { return axis.key == key; });
}

/// Rules between axes and what stays.
void check(const SweepSpec& spec) {
  if (spec.code.empty() && !has_axis(spec, "code"))
    throw IoError(spec.source_name,
                  "found no code; expected a line such as `codes = [\"hamiltonian-k4\"]`");
  const SweepAxis* first_zipped = nullptr;
  for (std::size_t i = 0; i < spec.axes.size(); ++i) {
    const SweepAxis& axis = spec.axes[i];
    check_axis_values(axis);
    for (std::size_t j = 0; j < i; ++j)
      if (spec.axes[j].key == axis.key)
        throw IoError(axis.place, fmt::format("axis {} comes twice; the first is at {}", axis.key,
                                              spec.axes[j].place));
    if (axis.key == "code" && !spec.code.empty())
      throw IoError(axis.place, "found both an axis of codes and `code`; expected one of them");
    if (spec.combine != SweepCombination::zip || axis.crossed) continue;
    if (first_zipped == nullptr) first_zipped = &axis;
    if (axis.values.size() != first_zipped->values.size())
      throw IoError(axis.place,
                    fmt::format("axis {} has {} values and {} has {}; with combine = \"zip\" "
                                "expected as many of each",
                                axis.key, axis.values.size(), first_zipped->key,
                                first_zipped->values.size()));
  }
  const auto asks_for_exposures = [](const std::string& code) {
    return code.find("{exposures}") != std::string::npos;
  };
  bool asked = asks_for_exposures(spec.code);
  for (const SweepAxis& axis : spec.axes)
    if (axis.key == "code")
      for (const SettingValue& value : axis.values) asked = asked || asks_for_exposures(value.text);
  if (asked != has_axis(spec, "exposures"))
    throw IoError(spec.source_name,
                  "an axis `exposures` and a code such as \"hamiltonian-k{exposures}\" need each "
                  "other; found one of them");
}

}  // namespace

SweepSpec parse_sweep_toml(std::string_view text, std::string_view source_name) {
  const TomlDocument document(text, source_name);
  SweepSpec spec;
  spec.source_name = source_name;
  spec.directory = std::filesystem::path(source_name).parent_path();
  TableReader::Places places;
  TableReader table(document, places);
  table.value("camera", spec.camera);
  table.value("set", spec.settings);
  table.choice("combine", spec.combine, Choices<SweepCombination>(combinations));
  read_options(table, spec.options);
  read_codes(table, spec);
  table.tables("axis", [&](TableReader& inner) { spec.axes.push_back(read_sweep_axis(inner)); });
  table.finish();
  check(spec);
  return spec;
}

SweepSpec read_sweep_toml(const std::filesystem::path& path) {
  return parse_sweep_toml(read_text_file(path), path.string());
}

}  // namespace tofsmith
