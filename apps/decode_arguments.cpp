// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "described_options.hpp"
#include "help_pages.hpp"
#include "number_checks.hpp"
#include "session.hpp"
#include "tap_arguments.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith::apps {

namespace {

/// Returns the exposures of a table with `measurements` columns, in the order of the camera.
std::vector<int> order_of(const std::vector<int>& given, const Camera& camera, int measurements,
                          const TapArguments& taps) {
  if (!given.empty()) return given;
  if (camera.playback && !camera.playback->order.empty()) return camera.playback->order;
  const bool reads_taps = camera.sensor.readout == Readout::separate && !camera.sensor.is_signed();
  const int side = reads_taps ? taps.file.taps.value_or(camera.sensor.taps) : 1;
  std::vector<int> order(
      static_cast<std::size_t>(measurements % side == 0 ? measurements / side : measurements));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

}  // namespace

void TableArguments::add_to(CLI::App& command) {
  const FieldOptions fields(command, options_);
  fields.add("range_m")->group(for_experts);
  fields.add("ambient")->group(for_experts);
  fields.add("axes", "--table-axes")->group(for_experts);
  fields.add("order")->allow_extra_args();
  fields.add("reversed", "--reverse");
  fields.add("keep_end_point")->group(for_experts);
}

DecodingSource TableArguments::load(const std::string& code, const Camera& camera,
                                    bool default_camera, const TapArguments& taps) const {
  DecodingTableOptions options = options_;
  options.file = taps.file_for({code});
  const char* const of_tables = options.range_m          ? "--range-m"
                                : options.ambient        ? "--ambient"
                                : options.axes           ? "--table-axes"
                                : options.keep_end_point ? "--keep-end-point"
                                                         : nullptr;
  if (of_tables && !names_measured_table(code)) {
    load_camera_code(code, camera, options.file);  // reports an invalid code first
    throw UsageError(
        fmt::format("{} is only valid with a measured table; {} is a code, for which the camera "
                    "determines these values",
                    of_tables, code));
  }
  DecodingSource source{load_decoding_table(code, camera, options), {}, {}, {}};
  if (options.range_m)
    source.range_source = "--range-m";
  else if (default_camera)
    source.range_source = fmt::format(
        "of the default camera {}; {}", camera.name,
        source.is_measured ? "--range-m or --camera override it" : "--camera overrides it");
  else
    source.range_source = fmt::format("of the camera {}", camera.name);
  source.tell_range = source.is_measured || default_camera;
  source.order = order_of(options.order, camera, source.table.measurements(), taps);
  return source;
}

namespace {

void list_devices(bool as_json) {
  const std::vector<Device> devices = Device::all();
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Device& device : devices) {
    const DeviceInfo& info = device.info();
    list.push_back({{"name", info.name},
                    {"kind", name_of(info.kind)},
                    {"memory_bytes", info.memory_bytes},
                    {"doubles", info.has_doubles},
                    {"platform", info.platform},
                    {"version", info.version}});
    if (!as_json)
      fmt::print("{}  {} ({}, {:.1f} GB, {}): {}, {}\n", list.size() - 1, info.name,
                 name_of(info.kind), 1e-9 * static_cast<double>(info.memory_bytes),
                 info.has_doubles ? "doubles" : "no doubles", info.platform, info.version);
  }
  if (as_json)
    fmt::print("{}\n", nlohmann::ordered_json({{"devices", list}}).dump(2));
  else if (devices.empty())
    fmt::print("{}\n", Device::none_found());
}

}  // namespace

void DeviceArguments::add_to(CLI::App& command) {
  command
      .add_option_function<std::string>(
          "--device",
          [this, &command](const std::string& name) {
            name_ = name;
            if (name != "list") return;
            const CLI::Option* json = command.get_parent()->get_option_no_throw("--json");
            list_devices(json && json->count() > 0);
            throw CLI::Success();
          },
          "device for averaging, filtering and decoding: cpu; gpu: the first OpenCL GPU; auto: "
          "the first GPU, but cpu for small frames and for methods other than zncc; list: print "
          "the OpenCL devices and exit; or an index or part of a name in this list. OpenCL "
          "devices support only zncc, with the same results as cpu")
      ->default_str(name_)
      ->group(for_experts);
}

std::unique_ptr<FrameBackend> DeviceArguments::backend(
    std::unique_ptr<const DepthDecoder> decoder) const {
  try {
    return frame_backend(name_, std::move(decoder));
  } catch (const std::invalid_argument& error) {
    throw wrong_option(error);
  }
}

namespace {

template <typename Options>
std::vector<std::string> keys_of(Options options = {}) {
  std::vector<std::string> names;
  for_each_field(options, [&](const auto& field) { names.emplace_back(field.name); });
  return names;
}

/// Sets the field named by "key=value" in `argument`.
/// @throws UsageError
template <typename Options>
void set_field(const char* argument, const std::string& setting, Options& options) {
  const std::size_t at = setting.find('=');
  if (at == std::string::npos)
    throw UsageError(fmt::format("{}: found {}; expected KEY=VALUE", argument, setting));
  const std::string key = setting.substr(0, at), value = setting.substr(at + 1);
  bool is_known = false;
  for_each_field(options, [&](const auto& field) {
    if (field.name != key) return;
    using Value = std::remove_cvref_t<decltype(field.value)>;
    constexpr bool is_integer = std::is_integral_v<Value>;
    constexpr const char* kind = std::is_same_v<Value, bool> ? "true or false"
                                 : is_integer                ? "an integer"
                                                             : "a number";
    is_known = true;
    if (!CLI::detail::lexical_cast(value, field.value))
      throw UsageError(fmt::format("{} {}: found {}; expected {}", argument, key, value, kind));
    if (!field.range.contains(static_cast<double>(field.value)))
      throw UsageError(fmt::format("{} {}: found {}; must be {}", argument, key, value,
                                   field.range.text(is_integer)));
  });
  if (is_known) return;
  const std::vector<std::string> keys = keys_of<Options>();
  const std::string near = nearest_word(key, keys);
  throw UsageError(fmt::format("{}: unknown key {}; expected one of {}{}", argument, key,
                               fmt::join(keys, ", "),
                               near.empty() ? "" : "; did you mean " + near + "?"));
}

/// Adds an option that sets fields of Options and requires another option.
template <typename Options>
void add_settings(CLI::App& command, const char* argument, const char* whose, CLI::Option* with,
                  std::vector<std::string>& settings) {
  command
      .add_option(argument, settings,
                  fmt::format("KEY=VALUE of {} (repeatable); keys: {}", whose,
                              fmt::join(keys_of<Options>(), ", ")))
      ->allow_extra_args(false)
      ->needs(with)
      ->group(for_experts);
}

}  // namespace

void FilterArguments::add_to(CLI::App& command) {
  CLI::Option* const filter = add_option_of(
      command,
      Field("filter", strength_,
            Help{"spatial filter, which averages measurements of neighbouring pixels at the same "
                 "depth before decoding: light, normal or strong"},
            IfAbsent{"off"}),
      "--filter");
  add_settings<FilterOptions>(command, "--filter-set", "the spatial filter", filter, settings_);
  CLI::Option* const time_filter =
      command
          .add_option("--time-filter", max_frames_,
                      "temporal filter, which averages each pixel over about this many frames "
                      "while the pixel does not change (default: off)")
          ->check(number_that(">= 1", [](double value) { return value >= 1.0; }))
          ->transform(number_in("", true));
  add_field_option(command, time_options_, "look_ahead")->needs(time_filter)->group(for_experts);
  add_settings<TimeFilterOptions>(command, "--time-filter-set", "the temporal filter", time_filter,
                                  time_settings_);
}

std::optional<FilterOptions> FilterArguments::options() const {
  if (!strength_) return std::nullopt;
  FilterOptions options = FilterOptions::of(*strength_);
  for (const std::string& setting : settings_) set_field("--filter-set", setting, options);
  return options;
}

std::optional<TimeFilterOptions> FilterArguments::time_options() const {
  if (max_frames_ == 0) return std::nullopt;
  TimeFilterOptions options = time_options_;
  options.max_frames = max_frames_;
  for (const std::string& setting : time_settings_)
    set_field("--time-filter-set", setting, options);
  return options;
}

}  // namespace tofsmith::apps
