// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "help_pages.hpp"

#include <fmt/format.h>

#include <vector>

namespace tofsmith::apps {

std::string HelpPages::make_help(const CLI::App* app, std::string name,
                                 CLI::AppFormatMode mode) const {
  if (mode != CLI::AppFormatMode::Normal) return CLI::Formatter::make_help(app, name, mode);
  std::string text = make_description(app) + make_usage(app, name) + make_positionals(app);
  std::size_t left_out = 0;
  for (const std::string& group : app->get_groups()) {
    const std::vector<const CLI::Option*> options = app->get_options(
        [&](const CLI::Option* o) { return o->nonpositional() && o->get_group() == group; });
    if (group == for_experts) left_out += options.size();
    if (!group.empty() && group != for_experts) text += make_group(group, false, options);
  }
  if (left_out > 0) text += fmt::format("\n{} more options: {} --help-all\n", left_out, name);
  return text + make_subcommands(app, mode) + "\n" + make_footer(app);
}

}  // namespace tofsmith::apps
