// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/run_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "io/documents/shared/document_text.hpp"
#include "sweep/item_key.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/csv.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

using Json = nlohmann::ordered_json;

/// Omits light levels, which every point contains, and the code, whose column has its full name.
std::vector<std::size_t> reported_axes(const SweepSpec& spec) {
  std::vector<std::size_t> axes;
  for (std::size_t a = 0; a < spec.axes.size(); ++a) {
    const std::string& key = spec.axes[a].key;
    if (key != "code" && !is_field_of<OperatingPoint>(key)) axes.push_back(a);
  }
  return axes;
}

void for_each_row(std::span<const SweepResult> results,
                  const std::function<void(const SweepResult&, const PointDepthError&)>& row) {
  for (const SweepResult& result : results)
    for (const PointDepthError& point : result.error.points) row(result, point);
}

bool is_numeric(const SweepAxis& axis) {
  return std::ranges::all_of(axis.values,
                             [](const SettingValue& value) { return value.number.has_value(); });
}

template <typename Value>
NpyArray list_array(const std::vector<Value>& values) {
  return NpyArray::of<Value>({values.size()}, values);
}

NpyArray names(const std::vector<std::string>& texts) {
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, text.size());
  std::vector<std::uint8_t> bytes(texts.size() * width, 0);
  for (std::size_t i = 0; i < texts.size(); ++i)
    std::ranges::copy(texts[i], bytes.begin() + static_cast<std::ptrdiff_t>(i * width));
  return NpyArray::of<std::uint8_t>({texts.size(), width}, bytes);
}

/// Writes indices into the distinct values, in order of appearance.
void add_texts(NpzArrays& arrays, const std::string& name, const std::vector<std::string>& texts) {
  std::vector<std::string> distinct;
  std::map<std::string, std::int64_t> index_of;
  std::vector<std::int64_t> indices;
  for (const std::string& text : texts) {
    const auto [found, is_new] =
        index_of.try_emplace(text, static_cast<std::int64_t>(distinct.size()));
    if (is_new) distinct.push_back(text);
    indices.push_back(found->second);
  }
  arrays[fmt::format("{}_index", name)] = list_array(indices);
  arrays[fmt::format("{}_names", name)] = names(distinct);
}

}  // namespace

std::vector<SweepResult> sweep_results(const WorkList& list, std::span<const std::string> keys,
                                       SweepStore& store) {
  std::vector<SweepResult> results;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto item = static_cast<std::int64_t>(i);
    const auto stored = store.find(keys[i]);
    if (!stored || stored->status != ItemStatus::finished) continue;
    ItemResult result =
        parse_item_result(stored->result, list.code_name(item), fmt::format("item {}", keys[i]));
    results.push_back({item, keys[i], std::move(result.error), std::move(result.designed)});
  }
  return results;
}

std::string sweep_csv(const WorkList& list, std::span<const SweepResult> results) {
  const SweepSpec& spec = list.spec();
  const std::vector<std::size_t> axes = reported_axes(spec);
  std::string text = "item,code";
  for (const std::size_t a : axes) text += fmt::format(",{}", csv_field(spec.axes[a].key));
  for (const PointColumn& column : point_columns({})) text += fmt::format(",{}", column.name);
  text += "\n";
  for_each_row(results, [&](const SweepResult& result, const PointDepthError& point) {
    text += fmt::format("{},{}", result.item + 1, csv_field(result.error.code));
    const std::vector<std::size_t> indices = spec.value_indices(result.item);
    for (const std::size_t a : axes)
      text += fmt::format(",{}", csv_field(spec.axes[a].values[indices[a]].text));
    for (const PointColumn& column : point_columns(point))
      text += std::isnan(column.value) ? "," : fmt::format(",{}", column.value);
    text += "\n";
  });
  return text;
}

std::string sweep_json(const WorkList& list, std::span<const SweepResult> results,
                       std::string_view target) {
  Json document = {
      {"tofsmith", TOFSMITH_VERSION}, {"results", sweep_result_version}, {"target", target},
      {"items", list.size()},         {"finished", results.size()},      {"axes", Json::array()},
      {"codes", Json::array()}};
  for (const SweepAxis& axis : list.spec().axes) {
    Json values = Json::array();
    for (const SettingValue& value : axis.values)
      values.push_back(value.number ? Json(*value.number) : Json(value.text));
    document["axes"].push_back({{"key", axis.key}, {"values", std::move(values)}});
  }
  for (const SweepResult& result : results) {
    Json entry = {{"item", result.item + 1},
                  {"key", result.key},
                  {"settings", Json::parse(list.settings_json(result.item))},
                  {"trials", result.error.trials},
                  {"seed", result.error.seed}};
    entry.update(depth_error_json(result.error, 0));
    if (result.code) entry["designed"] = Json::parse(code_to_json(*result.code));
    document["codes"].push_back(std::move(entry));
  }
  return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

NpzArrays sweep_arrays(const WorkList& list, std::span<const SweepResult> results) {
  const SweepSpec& spec = list.spec();
  NpzArrays arrays;
  std::vector<std::int64_t> items;
  std::vector<std::string> codes;
  for_each_row(results, [&](const SweepResult& result, const PointDepthError&) {
    items.push_back(result.item + 1);
    codes.push_back(result.error.code);
  });
  arrays["item"] = list_array(items);
  add_texts(arrays, "code", codes);
  for (const std::size_t a : reported_axes(spec)) {
    const SweepAxis& axis = spec.axes[a];
    std::vector<double> numbers;
    std::vector<std::string> texts;
    for_each_row(results, [&](const SweepResult& result, const PointDepthError&) {
      const SettingValue& value = axis.values[spec.value_indices(result.item)[a]];
      numbers.push_back(value.number.value_or(0.0));
      texts.push_back(value.text);
    });
    if (is_numeric(axis))
      arrays[axis.key] = list_array(numbers);
    else
      add_texts(arrays, axis.key, texts);
  }
  std::map<std::string, std::vector<double>> columns;
  for (const PointColumn& column : point_columns({})) columns[column.name] = {};
  for_each_row(results, [&](const SweepResult&, const PointDepthError& point) {
    for (const PointColumn& column : point_columns(point))
      columns[column.name].push_back(column.value);
  });
  for (const auto& [name, values] : columns) arrays[name] = list_array(values);
  return arrays;
}

}  // namespace tofsmith
