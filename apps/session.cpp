// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "help_pages.hpp"
#include "number_checks.hpp"
#include "tap_arguments.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/field_visitor.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith::apps {

namespace {

/// Returns the number of bytes of the first character of a text; 0 if it is not valid UTF-8 (RFC
/// 3629).
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t length = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : byte(0) >= 0xc2 ? 2 : 0;
  if (length == 0 || byte(0) > 0xf4 || text.size() < length) return 0;
  std::uint32_t code = byte(0) & (0xffu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3fu);
  }
  constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  return code >= least[length] && code <= 0x10ffff && !is_surrogate ? length : 0;
}

bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (character.size() == 1)
    return (first < ' ' && first != '\n' && first != '\t') || first == 0x7f;
  return first == 0xc2 && static_cast<unsigned char>(character[1]) < 0xa0;
}

}  // namespace

std::string printed(std::string_view message, std::size_t longest) {
  std::string text;
  for (std::size_t at = 0; at < message.size();) {
    if (text.size() > longest) return text + fmt::format(" ... ({} bytes)", message.size());
    const std::size_t length = utf8_length(message.substr(at));
    if (length == 0 || is_control(message.substr(at, length))) {
      fmt::format_to(std::back_inserter(text), "\\x{:02x}",
                     static_cast<unsigned char>(message[at]));
      ++at;
    } else {
      text += message.substr(at, length);
      at += length;
    }
  }
  return text;
}

UsageError wrong_option(const std::invalid_argument& error) {
  std::string text = error.what();
  // The names of these options omit the unit of the field.
  for (const std::string_view field : {"min_depth_m ", "max_depth_m "})
    if (text.starts_with(field)) text.erase(field.size() - 3, 2);
  const auto end = std::find(text.begin(), text.end(), ' ');
  // Keys of the camera, which contain a dot, are not options.
  if (std::find(text.begin(), end, '.') != end) return UsageError(text);
  std::replace(text.begin(), end, '_', '-');
  return UsageError("--" + text);
}

void Session::say(std::string_view line) const {
  if (!json) fmt::print("{}\n", printed(line, line.size()));
}

void Session::print_json(const nlohmann::ordered_json& document) const {
  print_document(document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void Session::print_document(std::string_view document) const {
  if (json) fmt::print("{}\n", document);
}

void Session::check_output(const std::filesystem::path& path,
                           std::optional<OutputPolicy> policy) const {
  std::vector<std::string> inputs;
  bool is_itself = false;
  for (const std::string& word : words) {
    // --option=value, and lists of values
    for (std::size_t begin = word.starts_with('-') ? word.find('=') + 1 : 0;
         begin <= word.size();) {
      const std::size_t end = std::min(word.find(',', begin), word.size());
      const std::string value = word.substr(begin, end - begin);
      if (value == path.string() && !is_itself)
        is_itself = true;
      else
        inputs.push_back(value);
      begin = end + 1;
    }
  }
  check_not_input(path, inputs);
  const AtomicFile probe(path, policy.value_or(output_policy()));  // never committed
}

OutputPolicy Session::check_outputs(const std::vector<std::filesystem::path>& paths) const {
  const OutputPolicy policy = policy_to_go_on(paths, output_policy());
  for (const std::filesystem::path& path : paths) check_output(path, policy);
  return policy;
}

void add_settings_option(CLI::App& command, std::vector<std::string>& settings) {
  command
      .add_option("--set", settings,
                  "override a camera key, e.g. --set light.peak_factor=5; an empty value, as in "
                  "--set sensor.adc_bits=, removes the key (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
}

void CameraArguments::add_to(CLI::App& command) {
  option = command.add_option("--camera", name, "camera file (.toml) or name of a built-in camera")
               ->capture_default_str();
  add_settings_option(command, settings);
}

void CameraArguments::add_positional(CLI::App& command) {
  command.add_option("CAMERA", name, "camera file (.toml) or name of a built-in camera")
      ->excludes(command.get_option("--camera"));
}

void CameraArguments::add_temperature_to(CLI::App& command) {
  command
      .add_option("--temperature", temperature_c,
                  "temperature of the camera [degrees C], which determines the drift described "
                  "in [temperature] (default: temperature.now_c, otherwise the reference)")
      ->transform(number_in("degrees C"))
      ->group(for_experts);
  command
      .add_option("--sensor-temperature", sensor_temperature_c,
                  "temperature of the sensor [degrees C], for cameras with [temperature.sensor] "
                  "(default: temperature.sensor.now_c, otherwise the reference)")
      ->transform(number_in("degrees C"))
      ->group(for_experts);
}

CLI::Option* CameraArguments::add_key_option(CLI::App& command, const std::string& key,
                                             const std::string& name) {
  const std::vector<KeyDescription> keys = describe_camera_keys(Camera());
  const auto described = std::ranges::find(keys, key, &KeyDescription::name);
  TOFSMITH_ASSERT_EQ(described != keys.end(), true);
  const std::string_view unit = unit_of_key(key);
  std::string help = full_help(unit, described->key.help, "", fmt::format("the camera's {}", key));
  help.front() = static_cast<char>(help.front() - 'A' + 'a');  // keys begin with a capital letter
  if (described->type == ValueType::choice)
    return command
        .add_option_function<std::string>(
            name,
            [this, key](const std::string& word) { key_settings_.push_back(key + "=" + word); },
            help)
        ->check(one_of(described->words));
  const Range range = described->key.range;
  const bool is_integer = described->type == ValueType::integer;
  return command
      .add_option_function<double>(
          name,
          [this, key](double value) { key_settings_.push_back(fmt::format("{}={}", key, value)); },
          help)
      ->transform(number_in(unit, is_integer))
      ->check(number_that(range.text(is_integer), [range](double v) { return range.contains(v); }));
}

std::filesystem::path camera_beside(const std::filesystem::path& raw) {
  return std::filesystem::path(raw).replace_extension(".camera.toml");
}

std::optional<std::string> CameraArguments::take_that_of(const std::filesystem::path& raw) {
  const std::filesystem::path beside = camera_beside(raw);
  std::error_code ignored;
  if (option == nullptr || option->count() > 0 || !std::filesystem::exists(beside, ignored))
    return std::nullopt;
  name = beside.string();
  stood_beside_ = true;
  return fmt::format("{}, next to {} (--camera overrides it)", name, raw.string());
}

Camera CameraArguments::load() const {
  std::vector<std::string> all_settings = settings;
  all_settings.insert(all_settings.end(), key_settings_.begin(), key_settings_.end());
  Camera camera = load_camera(name, all_settings);
  for (const std::string& note : unusual_numbers(camera))
    fmt::print(stderr, "tofsmith: note: {}: {}\n", printed(name), note);
  if (temperature_c) {
    if (!camera.temperature)
      throw UsageError(
          fmt::format("--temperature: {} has no [temperature]; expected a camera file from "
                      "`tofsmith calibrate temperature ... -o camera.toml`",
                      name));
    camera.temperature->now_c = temperature_c;
  }
  if (sensor_temperature_c) {
    if (!camera.temperature || !camera.temperature->sensor)
      throw UsageError(fmt::format(
          "--sensor-temperature: {} has no [temperature.sensor]; expected a camera file from "
          "`tofsmith calibrate temperature ... --sensor-column NAME -o camera.toml`",
          name));
    camera.temperature->sensor->now_c = sensor_temperature_c;
  }
  if (temperature_c || sensor_temperature_c) camera.validate();
  return camera;
}

std::string marked_note(const std::string& note) {
  const bool is_marked = note.starts_with("note: ") || note.starts_with("warning: ");
  return is_marked ? note : "note: " + note;
}

std::string time_text(double seconds) {
  return seconds < 1.0 ? fmt::format("{:.3g} ms", seconds * 1e3) : fmt::format("{:.3g} s", seconds);
}

std::string rate_text(double per_second) { return plain_number(per_second, 3); }

/// Returns the number of characters of UTF-8 text.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += i == 0 ? fmt::format("{:<{}}", row[i], widths[i])
                     : fmt::format("  {:>{}}", row[i], widths[i]);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace tofsmith::apps
