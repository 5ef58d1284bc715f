// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "help_pages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith::apps {

namespace {

constexpr std::size_t indent = 2, text_column = 26;

/// Section of options by task, with the names of its options. All other options are in the section
/// "Options".
struct Section {
  std::string_view title;
  std::vector<std::string_view> options;
};
/// Returns the sections in the order of help pages.
const std::vector<Section>& sections() {
  static const std::vector<Section> all = {
      {"Input",
       {"--depth", "--width", "--height", "--scale-m", "--raw-format", "--layout", "--dataset",
        "--frame", "--hdr", "--averaged", "--image", "--ambient-image", "--linear-image",
        "--reference", "--reference-kind", "--dark", "--shifts", "--target"}},
      {"Code and camera",
       {"--code", "--camera", "--set", "--order", "--reverse", "--temperature", "--taps",
        "--tap-order", "--range-m", "--ambient", "--table-axes", "--keep-end-point", "--rays",
        "--view-deg"}},
      {"Quality",
       {"--method", "--filter", "--time-filter", "--mixed", "--average", "--offset-map",
        "--offset-m", "--gain-map", "--stray-light", "--low-signal-sigma", "--min-confidence",
        "--false-alarm-rate", "--model-error-percent", "--trials", "--effort", "--seed",
        "--target-standard-error", "--max-trials"}},
      {"Output",
       {"-o,--output", "--outputs", "--stack", "--report", "--truth", "--export", "--table",
        "--all-points", "--undistort", "--json", "--force", "--quiet"}}};
  return all;
}

/// Returns "-o,--output", without the value of a flag that CLI11 adds.
std::string option_names(const CLI::Option& option) {
  return fmt::format("{}", fmt::join(dashed_names(option), ","));
}

std::string_view section_of(const CLI::Option& option) {
  const std::string names = option_names(option);
  for (const Section& section : sections())
    if (std::ranges::find(section.options, names) != section.options.end()) return section.title;
  return "Options";
}

/// Returns the columns of the terminal: COLUMNS, else the width of standard output, else 80.
std::size_t terminal_width() {
  constexpr int min_width = 40, max_width = 120, usual_width = 80;
  int width = 0;
  if (const char* const columns = std::getenv("COLUMNS")) width = std::atoi(columns);
  struct winsize size {};
  if (width <= 0 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) width = size.ws_col;
  return static_cast<std::size_t>(
      std::clamp(width > 0 ? width : usual_width, min_width, max_width));
}

/// Breaks a text into lines of the terminal's width.
/// @param at      column at which the first line begins
/// @param column  column at which the other lines begin
std::string wrapped(std::string_view text, std::size_t at, std::size_t column) {
  const std::size_t width = terminal_width();
  std::string result;
  bool begins_line = true;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (word.empty()) continue;
    if (!begins_line && at + 1 + word.size() > width) {
      result += "\n" + std::string(column, ' ');
      at = column;
      begins_line = true;
    }
    if (!begins_line) result += ' ';
    result += word;
    at += word.size() + (begins_line ? 0 : 1);
    begins_line = false;
  }
  return result + "\n";
}

/// Returns a name with its description in the second column.
std::string entry(const std::string& name, const std::string& text) {
  std::string line = std::string(indent, ' ') + name;
  line += line.size() + 2 > text_column ? "\n" + std::string(text_column, ' ')
                                        : std::string(text_column - line.size(), ' ');
  return line + wrapped(text, text_column, text_column);
}

/// Replacement for CLI11's "FLOAT:in (0, 1]": a placeholder, and the rule for the value.
struct ValueText {
  std::string placeholder, rule;
};
ValueText value_text(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0 || option.get_type_size() == 0) return {};  // a flag
  const std::string type = option.get_type_name();
  const std::size_t colon = type.find(':');
  const std::string kind = type.substr(0, colon);
  std::string rule = colon == std::string::npos ? "" : type.substr(colon + 1);
  if (rule.starts_with('{')) {
    constexpr std::size_t max_choices = 60;
    if (rule.size() > max_choices) {
      const std::string names = rule.substr(1, rule.size() - 2);
      return {"NAME", fmt::format("one of {}", fmt::join(CLI::detail::split(names, ','), ", "))};
    }
    std::ranges::replace(rule, ',', '|');
    return {rule, ""};
  }
  if (rule.starts_with(kind + " ")) rule.erase(0, kind.size() + 1);
  const bool is_number = kind == "FLOAT" || kind == "INT" || kind == "UINT";
  return {is_number ? "NUMBER" : "VALUE", rule};
}

/// Returns the rule, default and conditions of an option, which its description does not contain.
std::string remarks(const CLI::Option& option, const std::string& rule) {
  std::vector<std::string> all;
  if (!rule.empty()) all.push_back(rule);
  if (option.get_required()) all.emplace_back("required");
  if (!option.get_default_str().empty() && option.get_type_size() != 0)
    all.push_back("default: " + option.get_default_str());
  if (option.get_expected_max() >= CLI::detail::expected_max_vector_size &&
      !option.get_positional() && option.get_description().find("repeatable") == std::string::npos)
    all.emplace_back("repeatable");
  for (const CLI::Option* other : option.get_needs())
    all.push_back("requires " + option_names(*other));
  for (const CLI::Option* other : option.get_excludes())
    all.push_back("not with " +
                  (other->get_positional() ? other->get_single_name() : option_names(*other)));
  return all.empty() ? "" : fmt::format(" ({})", fmt::join(all, "; "));
}

/// Arguments of an example by the words of the command.
constexpr std::array<std::pair<std::string_view, std::string_view>, 18> examples = {{
    {" demo", "-o out"},
    {" cameras", "paper-10f0"},
    {" codes", "hamiltonian-k4"},
    {" design", "mine.toml --effort 0.1 -o designed"},
    {" atlas", "--taps 2 --exposures 4"},
    {" evaluate", "sinusoid-k4 hamiltonian-k4 --camera mine.toml"},
    {" multipath", "hamiltonian-k4 --camera mine.toml"},
    {" require", "mine.toml --error 5mm --distance 3m --klux 20"},
    {" export", "hamiltonian-k4 --camera mine.toml --format siglent-csv -o waveforms"},
    {" upload", "hamiltonian-k4 --camera mine.toml --instrument 192.168.0.10"},
    {" scene", "table-top -o look"},
    {" simulate", "table-top --code sinusoid-k4 --camera mine.toml -o raw.npy"},
    {" decode", "raw.npy --code sinusoid-k4 --camera mine.toml -o depth.npz"},
    {" report", "designed"},
    {" lab", "-o lab.html"},
    {" sweep", "sweep.toml --store results.db --export results.csv"},
    {" sweep merge", "all.db part-1.db part-2.db"},
    {" reproduce", "fig7"},
}};

}  // namespace

std::vector<std::string> dashed_names(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::string command_words(const CLI::App& command) {
  const CLI::App* const parent = command.get_parent();
  return parent == nullptr ? "" : command_words(*parent) + " " + command.get_name();
}

void add_examples(CLI::App& app) {
  const auto found =
      std::ranges::find(examples, command_words(app), &decltype(examples)::value_type::first);
  if (found != examples.end()) {
    const std::string footer = app.get_footer();
    app.footer(fmt::format("{}{}Example: tofsmith{} {}", footer, footer.empty() ? "" : "\n",
                           found->first, found->second));
  }
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    add_examples(*command);
}

std::string HelpPages::make_option(const CLI::Option* option, bool is_positional) const {
  const auto [placeholder, rule] = value_text(*option);
  std::string name = is_positional ? option->get_name(true, false) : option_names(*option);
  const bool is_many =
      is_positional && option->get_expected_max() >= CLI::detail::expected_max_vector_size;
  if (is_many) name += " ...";
  if (!is_positional && !placeholder.empty()) name += " " + placeholder;
  return entry(name, option->get_description() + remarks(*option, rule));
}

std::string HelpPages::make_group(std::string group, bool is_positional,
                                  std::vector<const CLI::Option*> options) const {
  if (options.empty()) return "";
  std::string text = "\n" + group + ":\n";
  for (const CLI::Option* option : options) text += make_option(option, is_positional);
  return text;
}

std::string HelpPages::make_subcommand(const CLI::App* command) const {
  return entry(command->get_name(), command->get_description());
}

std::string HelpPages::make_help(const CLI::App* app, std::string name,
                                 CLI::AppFormatMode mode) const {
  const auto options_where = [&](const auto& holds) {
    return app->get_options([&](const CLI::Option* o) {
      return o->nonpositional() && !o->get_group().empty() && holds(*o);
    });
  };
  const auto is_for_experts = [](const CLI::Option& o) { return o.get_group() == for_experts; };
  std::string text =
      wrapped(app->get_description(), 0, 0) + make_usage(app, name) + make_positionals(app);
  const auto add = [&](std::string_view title) {
    text += make_group(std::string(title), false, options_where([&](const CLI::Option& o) {
                         return !is_for_experts(o) && section_of(o) == title;
                       }));
  };
  for (const Section& section : sections()) add(section.title);
  add("Options");
  const std::vector<const CLI::Option*> experts = options_where(is_for_experts);
  if (mode == CLI::AppFormatMode::All)
    text += make_group("Advanced", false, experts);
  else if (!experts.empty())
    text += fmt::format("\n{} more options: {} --help-all\n", experts.size(), name);
  return text + make_subcommands(app, CLI::AppFormatMode::Normal) + "\n" + make_footer(app);
}

namespace {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

/// Returns {"a", "b"} for "TEXT:{a,b}"; empty if any value is allowed.
Words choices_of(const std::string& type) {
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  return CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
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
