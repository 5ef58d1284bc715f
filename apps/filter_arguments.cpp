// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "filter_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "session.hpp"
#include "tap_arguments.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith::apps {

namespace {

std::vector<std::string> keys() {
  std::vector<std::string> names;
  FilterOptions options;
  for_each_field(options, [&](const auto& field) { names.emplace_back(field.name); });
  return names;
}

/// Sets the field that "key=value" names. @throws UsageError
void set_field(const std::string& setting, FilterOptions& options) {
  const std::size_t at = setting.find('=');
  if (at == std::string::npos)
    throw UsageError(fmt::format("--filter-set: found {}; expected KEY=VALUE", setting));
  const std::string key = setting.substr(0, at), value = setting.substr(at + 1);
  bool is_known = false;
  for_each_field(options, [&](const auto& field) {
    if (field.name != key) return;
    is_known = true;
    if (!CLI::detail::lexical_cast(value, field.value) ||
        !keeps(static_cast<double>(field.value), field.rule))
      throw UsageError(
          fmt::format("--filter-set {}: found {}; must be {}", key, value, field.rule));
  });
  if (is_known) return;
  const std::string near = nearest_word(key, keys());
  throw UsageError(fmt::format("--filter-set: unknown key {}; expected one of {}{}", key,
                               fmt::join(keys(), ", "),
                               near.empty() ? "" : "; did you mean " + near + "?"));
}

}  // namespace

void FilterArguments::add_to(CLI::App& command) {
  std::vector<std::string> strengths;
  for (const FilterStrength strength : all_filter_strengths)
    strengths.emplace_back(name_of(strength));
  CLI::Option* const filter =
      command
          .add_option("--filter", strength_,
                      "add the measurements of neighbours that see the same depth before decoding: "
                      "light, normal or strong (off)")
          ->check(one_of(strengths));
  command
      .add_option("--filter-set", settings_,
                  fmt::format("KEY=VALUE of the filter, for experts, as often as needed: {}",
                              fmt::join(keys(), ", ")))
      ->allow_extra_args(false)
      ->needs(filter);
}

std::optional<FilterOptions> FilterArguments::options() const {
  if (strength_.empty()) return std::nullopt;
  FilterOptions options = FilterOptions::of(parse_filter_strength(strength_));
  for (const std::string& setting : settings_) set_field(setting, options);
  return options;
}

}  // namespace tofsmith::apps
