// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "number_checks.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith::apps {

namespace detail {

/// Adds an option whose texts, words or paths become values.
template <typename Value, typename Convert>
CLI::Option* add_converted(CLI::App& command, const std::string& option, Value& value,
                           const std::string& help, const Convert& convert) {
  if constexpr (is_list<Value>)
    return command.add_option_function<std::vector<std::string>>(
        option,
        [&value, convert](const std::vector<std::string>& texts) {
          value.clear();
          for (const std::string& text : texts) value.push_back(convert(text));
        },
        help);
  else
    return command.add_option_function<std::string>(
        option, [&value, convert](const std::string& text) { value = convert(text); }, help);
}

template <typename Single>
inline constexpr bool is_option_value =
    HasWords<Single> || std::is_arithmetic_v<Single> || std::is_same_v<Single, std::string> ||
    std::is_same_v<Single, std::filesystem::path> || NumberPair<Single>;

/// Returns the option of a field: "--split-exposures".
inline std::string option_of(std::string_view field) {
  std::string option(field);
  std::ranges::replace(option, '_', '-');
  return "--" + option;
}

}  // namespace detail

/// Adds an option with the help text, range, words, default and condition of a field. If the
/// condition is another option of the command, that option must have been added before.
/// @param option  such as "--trials"; of a flag that clears the field, "!--no-map"
template <typename Value>
CLI::Option* add_option_of(CLI::App& command, const Field<Value>& field,
                           const std::string& option) {
  using Single = SingleValue<Value>;
  // A condition that is another option is checked by CLI11.
  CLI::Option* const condition =
      field.only_with.empty() ? nullptr
                              : command.get_option_no_throw(fmt::format("--{}", field.only_with));
  std::string summary(field.help);
  if constexpr (NumberPair<Single>) summary += fmt::format("; example: {}", Single::example);
  const std::string help = full_help(
      field.unit(), summary, condition ? std::string_view() : field.only_with, field.if_absent);
  CLI::Option* added = nullptr;
  if constexpr (std::is_same_v<Value, bool>) {
    added = command.add_flag(option, field.value, option[0] == '!' ? "do not " + help : help);
  } else if constexpr (HasWords<Single>) {
    added = detail::add_converted(command, option, field.value, help, [](const std::string& word) {
      return parse_word<Single>("", word);
    });
    added->check(one_of<Single>());
    added->transform([](const std::string& name) {  // precedes the check
      return std::string(usual_word(Single{}, name));
    });
    if constexpr (std::is_enum_v<Value>) added->default_str(std::string(name_of(field.value)));
  } else if constexpr (std::is_same_v<Single, std::filesystem::path>) {
    added = detail::add_converted(command, option, field.value, help,
                                  [](const std::string& text) { return Single(text); });
  } else if constexpr (NumberPair<Single>) {
    added = detail::add_converted(
        command, option, field.value, help, [option](const std::string& text) {
          Single pair;
          auto [first, second] = fields_of(pair);
          if (!read_number_pair(text, Single::separator, first.value, second.value) ||
              !pair.is_valid())
            throw CLI::ValidationError(option, fmt::format("found {}; expected {}, such as {}",
                                                           text, Single::rule, Single::example));
          return pair;
        });
  } else {
    added = command.add_option(option, field.value, help);
    if constexpr (std::is_arithmetic_v<Single>) {
      if constexpr (is_list<Value>) {
        if (!field.value.empty()) added->capture_default_str();
      } else if constexpr (!is_optional<Value>) {
        added->capture_default_str();
      }
      added->transform(number_in(field.unit(), std::is_integral_v<Single>));
      if (field.range.is_restricted)
        added->check(number_that(field.range.text(std::is_integral_v<Single>),
                                 [range = field.range](double v) { return range.contains(v); }));
      else if (std::is_unsigned_v<Single>)
        added->check(number_that(">= 0", [](double v) { return v >= 0.0; }));  // CLI11 wraps -1
    }
  }
  if constexpr (is_list<Value>) added->delimiter(',')->allow_extra_args(false);
  if (condition) added->needs(condition);
  return added;
}

/// Adds the option of one field of a described struct.
/// @param field   its name
/// @param option  default: the name with dashes
template <typename Options>
CLI::Option* add_field_option(CLI::App& command, Options& options, std::string_view field,
                              const std::string& option = "") {
  CLI::Option* added = nullptr;
  for_each_field(options, [&](const auto& each) {
    using Single = SingleValue<std::remove_cvref_t<decltype(each.value)>>;
    if constexpr (detail::is_option_value<Single>)
      if (each.name == field)
        added = add_option_of(command, each, option.empty() ? detail::option_of(field) : option);
  });
  TOFSMITH_ASSERT_EQ(added != nullptr, true);  // a field of a type that options support
  return added;
}

/// Adds `--volts LOW,HIGH`, the voltages of waveforms.
inline void add_volts_option(CLI::App& command, ExportOptions& options) {
  command
      .add_option_function<std::vector<double>>(
          "--volts",
          [&options](const std::vector<double>& volts) {
            options.low_v = volts[0];
            options.high_v = volts[1];
          },
          "output voltages LOW,HIGH [V]: LOW for no light or zero gain, HIGH for peak light or "
          "full gain (default: 0,1)")
      ->delimiter(',')
      ->expected(2);
}

/// Adds options of fields of one struct to a command.
template <typename Options>
class FieldOptions {
 public:
  FieldOptions(CLI::App& command, Options& options) : command_(command), options_(options) {}

  CLI::Option* add(std::string_view field, const std::string& option = "") const {
    return add_field_option(command_, options_, field, option);
  }
  /// Adds the options that the command does not have yet.
  /// @param but  fields without an option, or with an option of another name
  void add_others(std::initializer_list<std::string_view> but) const {
    for_each_field(options_, [&](const auto& each) {
      using Single = SingleValue<std::remove_cvref_t<decltype(each.value)>>;
      if constexpr (detail::is_option_value<Single>)
        if (std::ranges::find(but, each.name) == but.end() &&
            !command_.get_option_no_throw(detail::option_of(each.name)))
          add(each.name);
    });
  }

 private:
  CLI::App& command_;
  Options& options_;
};

}  // namespace tofsmith::apps
