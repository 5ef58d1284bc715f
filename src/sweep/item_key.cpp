// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/item_key.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <iterator>
#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "camera/shared/depth_prior.hpp"
#include "core/shared/hash.hpp"
#include "io/documents/shared/document_text.hpp"
#include "io/text/shared/field_key.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/sweep/run_sweep.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

SweepCombination combination_of(const SweepSpec& spec, const std::string& group) {
  const auto found = spec.groups.find(group);
  return found == spec.groups.end() ? SweepCombination::zip : found->second;
}

std::int64_t size_of(const SweepSpec& spec, const AxisDigit& digit) {
  return static_cast<std::int64_t>(spec.axes[digit.front()].values.size());
}

/// Limits the product to 2^62.
std::int64_t counted_product(std::int64_t a, std::int64_t b) {
  constexpr std::int64_t max_count = std::int64_t{1} << 62;
  if (a == 0 || b == 0) return 0;
  return a > max_count / b ? max_count : a * b;
}

}  // namespace

std::vector<std::vector<AxisBlock>> axis_blocks(const SweepSpec& spec) {
  std::vector<AxisBlock> blocks;
  std::map<std::string, std::size_t> block_of_group;
  for (std::size_t a = 0; a < spec.axes.size(); ++a) {
    const SweepAxis& axis = spec.axes[a];
    std::size_t block = blocks.size();
    if (!axis.group.empty()) block = block_of_group.try_emplace(axis.group, block).first->second;
    if (axis.linked) block = axis.group.empty() ? blocks.size() - 1 : block;
    if (block == blocks.size()) blocks.emplace_back();
    std::vector<AxisDigit>& digits = blocks[block].digits;
    const bool joins = axis.linked || combination_of(spec, axis.group) == SweepCombination::zip;
    if (!digits.empty() && joins)
      digits.back().push_back(a);
    else
      digits.push_back({a});
  }
  std::vector<std::vector<AxisBlock>> lists;
  std::ptrdiff_t zipped = -1;
  for (AxisBlock& block : blocks) {
    for (const AxisDigit& digit : block.digits)
      block.size = counted_product(block.size, size_of(spec, digit));
    const SweepAxis& first = spec.axes[block.digits.front().front()];
    const bool is_zipped = spec.combine == SweepCombination::zip && !first.crossed;
    if (is_zipped && zipped >= 0) {
      lists[static_cast<std::size_t>(zipped)].push_back(std::move(block));
      continue;
    }
    if (is_zipped) zipped = static_cast<std::ptrdiff_t>(lists.size());
    lists.push_back({std::move(block)});
  }
  return lists;
}

std::string name_of(const SweepSpec& spec, const AxisBlock& block) {
  const SweepAxis& first = spec.axes[block.digits.front().front()];
  return first.group.empty() ? fmt::format("axis {}", first.key)
                             : fmt::format("group {}", first.group);
}

std::int64_t SweepSpec::items() const {
  std::int64_t count = 1;
  for (const std::vector<AxisBlock>& together : axis_blocks(*this))
    count = counted_product(count, together.front().size);
  return count;
}

std::vector<std::size_t> SweepSpec::value_indices(std::int64_t item) const {
  std::vector<std::size_t> indices(axes.size());
  const std::vector<std::vector<AxisBlock>> lists = axis_blocks(*this);
  for (auto together = lists.rbegin(); together != lists.rend(); ++together) {
    for (const AxisBlock& block : *together) {
      std::int64_t place = item % block.size;
      for (auto digit = block.digits.rbegin(); digit != block.digits.rend(); ++digit) {
        const std::int64_t base = size_of(*this, *digit);
        for (const std::size_t axis : *digit)
          indices[axis] = static_cast<std::size_t>(place % base);
        place /= base;
      }
    }
    item /= together->front().size;
  }
  return indices;
}

std::uint64_t key_number(std::string_view key) {
  std::uint64_t number = 0;
  const std::string_view digits = key.substr(0, 16);
  std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
  return number;
}

std::vector<std::int64_t> key_order(std::span<const std::string> keys) {
  struct Entry {
    std::uint64_t number;  // decides nearly all comparisons
    std::int64_t place;
  };
  const auto key_of = [&](const Entry& entry) -> const std::string& {
    return keys[static_cast<std::size_t>(entry.place)];
  };
  std::vector<Entry> entries;
  entries.reserve(keys.size());
  for (const std::string& key : keys)
    entries.push_back({key_number(key), static_cast<std::int64_t>(entries.size())});
  std::ranges::sort(entries, [&](const Entry& a, const Entry& b) {
    if (a.number != b.number) return a.number < b.number;
    return std::tie(key_of(a), a.place) < std::tie(key_of(b), b.place);
  });
  std::vector<std::int64_t> order;
  order.reserve(entries.size());
  const Entry* before = nullptr;
  for (const Entry& entry : entries) {
    if (before == nullptr || before->number != entry.number || key_of(*before) != key_of(entry))
      order.push_back(entry.place);
    before = &entry;
  }
  return order;
}

namespace {

/// Appends bits, because every digit of a switching time matters.
void append(std::string& text, double number) {
  fmt::format_to(std::back_inserter(text), "{:x} ", std::bit_cast<std::uint64_t>(number));
}

void append(std::string& text, const Waveform& waveform) {
  text += waveform.is_binary() ? "binary " : waveform.is_sampled() ? "sampled " : "cosines ";
  append(text, waveform.level());
  for (const OnInterval& interval : waveform.on_intervals()) {
    append(text, interval.rise);
    append(text, interval.fall);
  }
  for (const double sample : waveform.samples()) append(text, sample);
  for (const std::complex<double> c : waveform.coefficients()) {
    append(text, c.real());
    append(text, c.imag());
  }
  text += '\n';
}

/// Resets the keys of [operating] that other parts of item_key() contain; keeps all others, such as
/// new ones.
OperatingRange other_keys(OperatingRange range) {
  OperatingRange usual = paper_operating_range();
  // item_key() itself
  range.signal_e_per_s = std::move(usual.signal_e_per_s);
  range.ambient_e_per_s = std::move(usual.ambient_e_per_s);
  range.error = usual.error;
  range.albedo = usual.albedo;
  range.uniform_albedo = usual.uniform_albedo;
  range.neighbours = usual.neighbours;
  range.working_distance_m.reset();
  range.depths.reset();
  // setup_key() of designs, because evaluate() ignores them
  range.statistic = usual.statistic;
  range.multipath.reset();
  range.interference.reset();
  range.velocity_m_per_s.reset();
  return range;
}

/// Omits the name; responses become samples regardless of their source.
std::string camera_text(const Camera& camera) {
  Camera plain = camera;
  plain.name = "camera";
  plain.operating = other_keys(std::move(plain.operating));
  for (ImpulseResponse* response : {&plain.light.impulse_response, &plain.sensor.impulse_response})
    if (!response->samples.empty()) response->file.clear();
  return camera_to_json(plain);
}

void append(std::string& text, std::string_view name, std::span<const double> numbers) {
  text += name;
  for (const double number : numbers) append(text, number);
  text += '\n';
}

/// Options that differ from their defaults, except for the fields that item_key() always includes.
std::string other_options(const EvaluateOptions& options) {
  static constexpr std::array<std::string_view, 7> always = {
      "trials",    "seed",           "outlier_threshold_m",
      "method",    "unwrap_weights", "target_standard_error",
      "max_trials"};
  const auto texts = [](const EvaluateOptions& its) {
    std::vector<std::string> all;
    for_each_field(its, [&](const auto& field) {
      std::string text = fmt::format("{} ", field.name);
      append_key(text, field.value);
      if (std::ranges::find(always, field.name) == always.end()) all.push_back(std::move(text));
    });
    return all;
  };
  const std::vector<std::string> given = texts(options), usual = texts({});
  std::string others;
  for (std::size_t i = 0; i < given.size(); ++i)
    if (given[i] != usual[i]) others += given[i] + "\n";
  return others;
}

}  // namespace

std::string setup_key(const Camera& camera, const CodeSet& code) {
  std::string text = camera_text(camera);
  fmt::format_to(std::back_inserter(text), "code {} {} {}\n", code.samples(), code.exposures(),
                 code.taps());
  for (int e = 0; e < code.exposures(); ++e) append(text, code.modulation(e));
  for (int i = 0; i < code.measurements(); ++i) append(text, code.demodulation(i));
  if (!code.exposure_shares().empty()) append(text, "exposure shares ", code.exposure_shares());
  return fnv1a_128_hex(text);
}

std::string setup_key(const Camera& camera, const DesignOptions& options, double effort) {
  std::string text = camera_text(camera);
  fmt::format_to(std::back_inserter(text), "designed by {} with effort {}: {} exposures {}\n",
                 TOFSMITH_VERSION, effort, name_of(options.method),
                 fmt::join(options.exposures, ","));
  // Irrelevant to evaluate(), but not to design(). The bindings do not compile if a member is
  // missing.
  if (camera.operating.multipath) {
    const auto& [ratio, delay_m, weight] = *camera.operating.multipath;
    append(text, "ratio ", ratio);
    append(text, "delay ", delay_m);
    append(text, "weight ", {&weight, 1});
  }
  if (camera.operating.interference) {
    const auto& [cameras, signal_ratio, code, offset_hz, spreading, parts] =
        *camera.operating.interference;
    const double numbers[] = {static_cast<double>(cameras), signal_ratio, offset_hz,
                              static_cast<double>(parts)};
    append(text, "interference ", numbers);
    fmt::format_to(std::back_inserter(text), "{} {}\n", code, static_cast<int>(spreading));
  }
  if (const auto& velocity = camera.operating.velocity_m_per_s)
    append(text, "velocity ", {&*velocity, 1});
  if (camera.operating.statistic != ErrorStatistic::mae)
    fmt::format_to(std::back_inserter(text), "statistic {}\n",
                   static_cast<int>(camera.operating.statistic));
  return fnv1a_128_hex(text);
}

std::string item_key(std::string_view setup, const OperatingRange& light,
                     const EvaluateOptions& options) {
  const bool unwraps = options.method == DecodeMethod::unwrap;
  std::string text = fmt::format("results {}\nmethod {} {}\ntrials {}\nseed {}\nsetup {}\n",
                                 sweep_result_version, name_of(options.method),
                                 unwraps ? name_of(options.unwrap_weights) : std::string_view(),
                                 options.trials, options.seed, setup);
  append(text, "outlier ", {&options.outlier_threshold_m, 1});
  if (options.target_standard_error > 0.0) {
    const double goal[] = {options.target_standard_error, static_cast<double>(options.max_trials)};
    append(text, "target ", goal);
  }
  text += other_options(options);
  append(text, "signal ", light.signal_e_per_s);
  append(text, "ambient ", light.ambient_e_per_s);
  append(text, "albedo ", {&light.albedo, 1});
  fmt::format_to(std::back_inserter(text), "{} {}\n", light.uniform_albedo,
                 static_cast<int>(light.error));
  if (light.neighbours != 1)
    fmt::format_to(std::back_inserter(text), "neighbours {}\n", light.neighbours);
  if (light.working_distance_m) append(text, "working distance ", *light.working_distance_m);
  if (light.depths && !DepthPrior::are_alike(*light.depths)) append(text, "depths ", *light.depths);
  return fnv1a_128_hex(text);
}

std::string item_result_json(const DepthErrorReport& report, const CodeSet* designed) {
  nlohmann::ordered_json entry = {{"trials", report.trials},
                                  {"seed", report.seed},
                                  {"outlier_threshold_m", report.outlier_threshold_m}};
  entry.update(depth_error_json(report, 0));
  entry.erase("name");
  entry.erase("rotation_bin");
  if (designed) entry["designed"] = nlohmann::ordered_json::parse(code_to_json(*designed));
  return entry.dump();
}

ItemResult parse_item_result(const std::string& json, const std::string& code,
                             std::string_view file) {
  Document document = parse_json(json, file);
  const ValueReader reader(document);
  nlohmann::json& entry = document.root();
  if (!entry.is_object()) reader.mistyped("the result of an item");
  entry["name"] = code;
  ItemResult result{depth_error_from_json(reader, reader), {}};
  if (const auto designed = reader.optional_member("designed"))
    result.designed = code_from_json(*designed).renamed(code);
  return result;
}

}  // namespace tofsmith
