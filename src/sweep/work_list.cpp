// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/run_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "sweep/item_key.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/decoding_table_file.hpp"

namespace tofsmith {

namespace {

using Json = nlohmann::ordered_json;

/// Fixed values and settings, and the values of the axes.
struct Choice : ItemValues {
  std::vector<std::string> settings;
};

std::string replaced(std::string text, std::string_view what, const std::string& by) {
  for (std::size_t at; (at = text.find(what)) != std::string::npos;)
    text.replace(at, what.size(), by);
  return text;
}

Choice choose(const SweepSpec& spec, std::int64_t item) {
  Choice choice{{.camera = spec.camera, .code = spec.code, .options = spec.options}, spec.settings};
  const std::vector<std::size_t> indices = spec.value_indices(item);
  for (std::size_t a = 0; a < spec.axes.size(); ++a) {
    const std::string& key = spec.axes[a].key;
    const SettingValue& value = spec.axes[a].values[indices[a]];
    if (!set_value(choice, key, value))
      choice.settings.push_back(fmt::format("{}={}", key, value.toml));
    else if (is_field_of<OperatingPoint>(key))
      choice.settings.push_back(fmt::format("operating.{}=[{}]", key, value.toml));
  }
  choice.code =
      replaced(std::move(choice.code), "{exposures}", fmt::format("{}", choice.exposures));
  return choice;
}

/// Returns a built-in name, or a path relative to the sweep's file.
std::string resolved(const SweepSpec& spec, const std::string& name, bool is_ours) {
  return is_ours || name.empty() ? name : (spec.directory / name).string();
}

Camera load_chosen_camera(const SweepSpec& spec, const Choice& choice) {
  const auto names = built_in_camera_names();
  const bool built_in = std::ranges::find(names, choice.camera) != names.end();
  return load_camera(resolved(spec, choice.camera, built_in), choice.settings);
}

/// Returns 4 for "optimized-k4"; none for existing codes.
std::optional<int> designed_exposures(std::string_view code) {
  constexpr std::string_view stem = "optimized-k";
  int exposures = 0;
  if (!code.starts_with(stem)) return std::nullopt;
  const char* const end = code.data() + code.size();
  const auto [rest, error] = std::from_chars(code.data() + stem.size(), end, exposures);
  if (error != std::errc() || rest != end) return std::nullopt;
  return exposures;
}

/// Depends only on the item.
DesignOptions design_options(const SweepSpec& spec, const EvaluateOptions& options, int exposures) {
  if (options.method != DecodeMethod::zncc)
    reject("method", name_of(options.method), "must be zncc to design codes");
  if (options.target_standard_error > 0.0)
    reject("target_standard_error", fmt::format("{}", options.target_standard_error),
           "must be 0 to design codes, which use a fixed number of trials");
  DesignOptions design;
  design.method = DesignMethod::optimize;
  design.exposures = {exposures};
  design.baselines.emplace();
  design.atlas_cameras = 0;  // results must not depend on the atlas
  design.trials = static_cast<int>(options.trials);
  design.seed = options.seed;
  design.outlier_threshold_m = options.outlier_threshold_m;
  design.validate();
  return with_effort(std::move(design), spec.effort);
}

CodeSet load_chosen_code(const SweepSpec& spec, const Choice& choice, const Camera& camera) {
  // Another name may be a misspelled family, which load_camera_code() reports.
  const std::string file = resolved(spec, choice.code, is_family(choice.code));
  std::error_code ignored;  // such as a name that is too long
  const bool is_file = std::filesystem::exists(file, ignored);
  CodeSet code = load_camera_code(is_file ? file : choice.code, camera);
  require_fits(code, camera);
  return code;
}

/// Returns the place of the axis value; "" if the setting is not from an axis.
/// @param setting  place of an error, which begins with the setting
std::string place_of_setting(const SweepSpec& spec, std::int64_t item, std::string_view setting) {
  const std::vector<std::size_t> indices = spec.value_indices(item);
  for (std::size_t a = 0; a < spec.axes.size(); ++a) {
    const SettingValue& value = spec.axes[a].values[indices[a]];
    for (const std::string& made :
         {fmt::format("setting '{}={}'", spec.axes[a].key, value.toml),
          fmt::format("setting 'operating.{}=[{}]'", spec.axes[a].key, value.toml)})
      if (setting.starts_with(made)) return value.place;
  }
  return "";
}

/// Builds a camera and a code that several items share only once.
class SetupCache {
 public:
  explicit SetupCache(const WorkList& list) : list_(list) {
    for (std::size_t a = 0; a < list.spec().axes.size(); ++a) {
      const std::string& key = list.spec().axes[a].key;
      // With two axes for the light levels, the last one takes effect.
      if (key.starts_with("operating")) sets_light_twice_ = true;
      if (!is_field_of<EvaluateOptions>(key) && !is_field_of<OperatingPoint>(key))
        setup_axes_.push_back(a);
    }
  }

  /// @throws IoError as WorkList::item()
  std::string key(std::int64_t item) {
    const SweepSpec& spec = list_.spec();
    const Choice choice = choose(spec, item);
    const bool is_plain = !sets_light_twice_ && !(choice.light.signal_e_per_s <= 0.0) &&
                          !designed_exposures(choice.code);
    const std::optional<Setup> setup = is_plain ? setup_of(item) : std::nullopt;
    if (!setup) return list_.item(item).key;
    OperatingRange light = setup->light;
    if (!std::isnan(choice.light.signal_e_per_s))
      light.signal_e_per_s = {choice.light.signal_e_per_s};
    if (!std::isnan(choice.light.ambient_e_per_s))
      light.ambient_e_per_s = {choice.light.ambient_e_per_s};
    return item_key(setup->key, light, choice.options);
  }

 private:
  struct Setup {
    std::string key;
    OperatingRange light;
  };
  static constexpr std::size_t max_kept = 100'000;

  /// Returns none if the cache is full; the setup is then built for each item.
  std::optional<Setup> setup_of(std::int64_t item) {
    const std::vector<std::size_t> indices = list_.spec().value_indices(item);
    std::vector<std::size_t> own;
    for (const std::size_t a : setup_axes_) own.push_back(indices[a]);
    {
      const std::lock_guard lock(mutex_);
      if (const auto found = setups_.find(own); found != setups_.end()) return found->second;
      if (setups_.size() >= max_kept) return std::nullopt;
    }
    const WorkItem built = list_.item(item);
    const Setup setup{setup_key(built.camera, *built.code), built.camera.operating};
    const std::lock_guard lock(mutex_);
    return setups_.emplace(std::move(own), setup).first->second;
  }

  const WorkList& list_;
  bool sets_light_twice_ = false;
  std::vector<std::size_t> setup_axes_;
  std::mutex mutex_;
  std::map<std::vector<std::size_t>, Setup> setups_;
};

}  // namespace

std::string WorkList::code_name(std::int64_t item) const { return choose(spec_, item).code; }

std::string WorkList::settings_json(std::int64_t item) const {
  const std::vector<std::size_t> indices = spec_.value_indices(item);
  Json settings = {{"code", code_name(item)}};
  for (std::size_t a = 0; a < spec_.axes.size(); ++a) {
    const SettingValue& value = spec_.axes[a].values[indices[a]];
    if (spec_.axes[a].key == "code") continue;
    if (value.number)
      settings[spec_.axes[a].key] = Json::parse(fmt::format("{}", *value.number));
    else
      settings[spec_.axes[a].key] = value.text;
  }
  return settings.dump(-1, ' ', false, Json::error_handler_t::replace);
}

WorkItem WorkList::item(std::int64_t item) const {
  const Choice choice = choose(spec_, item);
  try {
    const Camera camera = load_chosen_camera(spec_, choice);
    if (const auto exposures = designed_exposures(choice.code)) {
      DesignOptions options = design_options(spec_, choice.options, *exposures);
      std::string key =
          item_key(setup_key(camera, options, spec_.effort), camera.operating, choice.options);
      return {std::move(key), camera, std::nullopt, choice.options, std::move(options)};
    }
    CodeSet code = load_chosen_code(spec_, choice, camera);
    std::string key = item_key(setup_key(camera, code), camera.operating, choice.options);
    return {std::move(key), camera, std::move(code), choice.options};
  } catch (const std::exception& error) {
    const auto* const file_error = dynamic_cast<const IoError*>(&error);
    if (file_error == nullptr && dynamic_cast<const std::invalid_argument*>(&error) == nullptr)
      throw;
    const std::string place =
        file_error == nullptr ? "" : place_of_setting(spec_, item, file_error->place());
    throw IoError(place.empty() ? spec_.source_name : place,
                  fmt::format("{} (in item {} of {}: {})", error.what(), item + 1, size_,
                              settings_json(item)));
  }
}

std::vector<std::string> WorkList::keys(const Progress& progress) const {
  constexpr std::int64_t block = 4096;
  SetupCache setups(*this);
  std::vector<std::string> keys(static_cast<std::size_t>(size_));
  for (std::int64_t begin = 0; begin < size_; begin += block) {
    report(progress, static_cast<double>(begin) / static_cast<double>(size_), "reading items");
    parallel_for_blocks(std::min(block, size_ - begin), 64, [&](IndexRange range) {
      for (std::int64_t i = range.begin; i < range.end; ++i)
        keys[static_cast<std::size_t>(begin + i)] = setups.key(begin + i);
    });
  }
  return keys;
}

}  // namespace tofsmith
