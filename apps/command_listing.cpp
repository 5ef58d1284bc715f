// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "command_listing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "help_pages.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith::apps {

namespace {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

/// Returns {"a", "b"} for "TEXT:{a,b}"; empty if any value is allowed.
Words choices_of(const std::string& type) {
  Words choices;
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return choices;
  for (std::size_t i = begin + 1; i < end;) {
    const std::size_t comma = std::min(type.find(',', i), end);
    choices.push_back(type.substr(i, comma - i));
    i = comma + 1;
  }
  return choices;
}

Words names_of(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_single_name()};
  return dashed_names(option);
}

/// Returns the long names of the options, sorted.
Words names_of(const std::set<CLI::Option*>& options) {
  Words names;
  for (const CLI::Option* option : options) names.push_back(names_of(*option).back());
  std::sort(names.begin(), names.end());
  return names;
}

Json argument(const CLI::Option& option) {
  Json item = {{"names", names_of(option)}, {"help", option.get_description()}};
  if (option.get_group() == for_experts) item["for_experts"] = true;
  if (!option.get_needs().empty()) item["needs"] = names_of(option.get_needs());
  if (!option.get_excludes().empty()) item["excludes"] = names_of(option.get_excludes());
  if (option.get_type_size() != 0) {
    const std::string type = option.get_type_name();
    item["value"] = type;
    if (!option.get_default_str().empty()) item["default"] = option.get_default_str();
    if (const Words choices = choices_of(type); !choices.empty()) item["choices"] = choices;
    item["required"] = option.get_required();
    item["many"] = option.get_items_expected_max() > 1;
  }
  return item;
}

/// Returns names of codes that can be used directly: "hamiltonian-k4" for the family
/// "hamiltonian-kK".
Words code_names() {
  Words names;
  for (const FamilyDescription& family : list_families()) {
    const std::size_t letter = family.name.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ");
    if (letter == std::string::npos) {
      names.push_back(family.name);
      continue;
    }
    for (int number = 2; number <= 8; ++number) {
      const std::string_view pattern = family.name;
      std::string name =
          fmt::format("{}{}{}", pattern.substr(0, letter), number, pattern.substr(letter + 1));
      if (is_family(name)) names.push_back(std::move(name));
    }
  }
  return names;
}

std::vector<const CLI::App*> subcommands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

void list_command(const CLI::App& app, const Words& words, Json& commands) {
  Json command = {{"words", words}, {"summary", app.get_description()}};
  // Subcommands without examples inherit the program's examples.
  if (app.get_parent() == nullptr || app.get_footer() != app.get_parent()->get_footer())
    command["example"] = app.get_footer();
  Json subcommands = Json::array(), positionals = Json::array(), options = Json::array();
  for (const CLI::App* sub : subcommands_of(app)) subcommands.push_back(sub->get_name());
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty())  // hidden options have no group
      (option->get_positional() ? positionals : options).push_back(argument(*option));
  command["subcommands"] = subcommands;
  command["positionals"] = positionals;
  command["options"] = options;
  commands.push_back(std::move(command));
  for (const CLI::App* sub : subcommands_of(app)) {
    Words longer = words;
    longer.push_back(sub->get_name());
    list_command(*sub, longer, commands);
  }
}

}  // namespace

Json command_listing(const CLI::App& app) {
  Json commands = Json::array();
  list_command(app, {}, commands);
  return {{"version", TOFSMITH_VERSION},
          {"names",
           {{"camera", built_in_camera_names()},
            {"code", code_names()},
            {"scene", built_in_scene_names()}}},
          {"commands", commands}};
}

}  // namespace tofsmith::apps
