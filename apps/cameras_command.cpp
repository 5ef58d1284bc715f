// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "session.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/raw_format.hpp"

namespace tofsmith::apps {

namespace {

nlohmann::ordered_json entry_of(const BuiltInCamera& listed, const Camera& camera) {
  return {{"name", listed.name},
          {"description", listed.description},
          {"code", listed.code},
          {"fundamental_frequency_hz", camera.fundamental_frequency_hz},
          {"range_m", camera.range_m()}};
}

void list_cameras(const Session& session) {
  nlohmann::ordered_json document = nlohmann::ordered_json::array();
  std::string text;
  for (const BuiltInCamera& listed : list_built_in_cameras()) {
    const Camera camera = built_in_camera(listed.name);
    document.push_back(entry_of(listed, camera));
    text += fmt::format("  {:20}  {}\n  {:20}  f0 {:.4g} MHz, range {:.2f} m{}\n", listed.name,
                        listed.description, "", camera.fundamental_frequency_hz / 1e6,
                        camera.range_m(), listed.code.empty() ? "" : ", code " + listed.code);
  }
  session.print_json(document);
  session.say("Built-in cameras:\n" + text +
              "To describe your own camera, start with `tofsmith cameras kinect-v2 > mine.toml`.");
}

void show_camera(const Session& session, const std::string& name) {
  std::string toml = built_in_camera_toml(name);
  const Camera camera = built_in_camera(name);
  const std::vector<BuiltInCamera> all = list_built_in_cameras();
  const auto listed = std::ranges::find(all, name, &BuiltInCamera::name);
  nlohmann::ordered_json document = entry_of(*listed, camera);
  document["camera"] = nlohmann::ordered_json::parse(camera_to_json(camera));
  document["sources"] = nlohmann::ordered_json::object();
  for (const NumberSource& known : listed->sources) document["sources"][known.key] = known.source;
  session.print_json(document);
  toml.pop_back();  // say() ends the line
  session.say(toml);
}

/// Prints a camera file, or a camera with changed keys, including all defaults.
void show_changed(const Session& session, const std::string& name_or_path, Settings settings) {
  const Camera camera = load_camera(name_or_path, settings);
  session.print_json({{"name", camera.name},
                      {"fundamental_frequency_hz", camera.fundamental_frequency_hz},
                      {"range_m", camera.range_m()},
                      {"camera", nlohmann::ordered_json::parse(camera_to_json(camera))}});
  std::string toml = camera_to_toml(camera);
  toml.pop_back();  // say() ends the line
  std::string with;
  for (const std::string& setting : settings) with += ", " + setting;
  session.say(fmt::format("# {}{}, including all defaults: range {:.2f} m\n{}", name_or_path, with,
                          camera.range_m(), toml));
}

/// Returns type, unit, range, condition and default of a key, such as "number [Hz], finite and > 0;
/// default 1.0".
std::string value_text(const nlohmann::ordered_json& key) {
  std::string text = key["type"].get<std::string>();
  std::replace(text.begin(), text.end(), '_', ' ');
  if (key.contains("words")) {
    const auto words = key["words"].get<std::vector<std::string>>();
    text = text == "choice" ? fmt::format("{}", fmt::join(words, " | "))
                            : fmt::format("number or {}", words.front());
  }
  const auto add = [&](const char* format, const std::string& what) {
    if (!what.empty()) text += fmt::format(fmt::runtime(format), what);
  };
  add(" [{}]", key["unit"]);
  add(", {}", key["range"]);
  add("; only with {}", key["condition"]);
  if (!key["example"].get<std::string>().empty())
    add("; required, such as {}", key["example"]);
  else if (key.contains("default") && !key["default"].is_null())
    add("; default {}", key["default"].dump());
  return text;
}

/// @param json  list of keys
/// @param title  heading of the list
void list_keys(const Session& session, const std::string& json, const std::string& title) {
  const auto keys = nlohmann::ordered_json::parse(json);
  session.print_json(keys);
  std::string text = title + ":\n";
  for (const auto& key : keys) {
    const auto help = key["help"].get<std::string>();
    if (key["type"] == "table")
      text += fmt::format("\n[{}]  {}\n", key["key"].get<std::string>(), help);
    else
      text += fmt::format("  {:40} {}\n  {:40}   {}\n", key["key"].get<std::string>(), help, "",
                          value_text(key));
  }
  text.pop_back();  // say() ends the line
  session.say(text);
}

void show_raw_format(const Session& session, const std::string& name) {
  if (name.empty())
    throw UsageError(fmt::format("--raw-format requires the NAME of a camera ({}), or --keys",
                                 fmt::join(built_in_raw_format_names(), ", ")));
  std::string toml = built_in_raw_format_toml(name);
  session.print_json({{"name", name}, {"raw_format", toml}});
  toml.pop_back();
  session.say(toml);
}

}  // namespace

void add_cameras_command(CLI::App& app, Session& session) {
  auto name = std::make_shared<std::string>();
  auto settings = std::make_shared<std::vector<std::string>>();
  auto raw_format = std::make_shared<bool>(false);
  auto keys = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("cameras", "list the built-in cameras, or print a camera as TOML");
  command->add_option("NAME", *name, "built-in camera or camera file (.toml)");
  add_settings_option(*command, *settings);
  command->add_flag(
      "--raw-format", *raw_format,
      "print the description of the camera's raw frames instead of the camera (input for "
      "`decode --raw-format`)");
  command
      ->add_flag("--keys", *keys,
                 "list the keys of camera files with unit, range and default; with --raw-format, "
                 "list the keys of raw formats instead")
      ->excludes("NAME", "--set");
  command->callback([name, settings, raw_format, keys, &session] {
    if (*keys && *raw_format)
      return list_keys(session, raw_format_keys_json(), "Keys of a raw format (.raw.toml)");
    if (*keys) return list_keys(session, camera_keys_json(), "Keys of a camera file");
    if (!settings->empty() && (*raw_format || name->empty()))
      throw UsageError(
          "--set is only valid when a camera is printed: expected NAME, without --raw-format");
    if (*raw_format) return show_raw_format(session, *name);
    if (name->empty()) return list_cameras(session);
    if (!settings->empty() || std::filesystem::path(*name).extension() == ".toml")
      return show_changed(session, *name, *settings);
    show_camera(session, *name);
  });
}

}  // namespace tofsmith::apps
