// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "tofsmith/instrument/scpi_session.hpp"
#include "tofsmith/instrument/upload.hpp"

namespace tofsmith {

namespace {

std::string plain_upper(std::string_view text) {
  std::string result;
  for (const char c : text)
    if (c != '"') result += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return result;
}

/// Of "C1:BSWV WVTP,ARB,FRQ,1000HZ" the value behind a key; of "C1:OUTP ON,LOAD,50", whose first
/// word stands alone, that word for the key "".
std::optional<std::string> value_in(const std::string& answer, std::string_view key) {
  const std::size_t blank = answer.find(' ');
  const std::string body = blank == std::string::npos ? answer : answer.substr(blank + 1);
  std::string_view last;
  for (std::size_t begin = 0; begin <= body.size();) {
    const std::size_t end = std::min(body.find(',', begin), body.size());
    const std::string_view word = std::string_view(body).substr(begin, end - begin);
    if (key.empty() || last == key) return std::string(word);
    last = word;
    begin = end + 1;
  }
  return std::nullopt;
}

/// A number and perhaps its unit.
std::optional<double> number_and_unit(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = std::numeric_limits<double>::quiet_NaN();
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return std::nullopt;
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  for (const char* known : {"", "HZ", "V", "VPP", "S", "SA/S", "OHM", "DEG"})
    if (unit == known) return value;
  return std::nullopt;
}

bool is_text_wanted(const AnswerCheck& check, const std::string& found) {
  for (const std::string& text : check.texts)
    if (check.within ? found.find(text) != std::string::npos : found == text) return true;
  return false;
}

}  // namespace

std::string answer_problem(const AnswerCheck& check, const std::string& answer, double* value) {
  const std::string upper = plain_upper(answer);
  const bool siglent_state = upper.find(":OUTP ") != std::string::npos;
  std::optional<std::string> found = upper;
  if (!check.field.empty() || siglent_state) found = value_in(upper, check.field);
  if (!found)
    return fmt::format("found '{}'; expected {} in it", printable(answer, 200), check.field);
  const std::string of_what =
      check.quantity.empty()
          ? ""
          : fmt::format(
                "{}{}: ", check.channel > 0 ? fmt::format("channel {} ", check.channel) : "",
                check.quantity);
  if (!check.texts.empty())
    return is_text_wanted(check, *found)
               ? ""
               : fmt::format("{}found '{}'; expected {}", of_what, printable(*found, 200),
                             fmt::join(check.texts, " or "));
  const std::optional<double> number = number_and_unit(*found);
  if (!number)
    return fmt::format("{}found '{}'; expected the number {:g}", of_what, printable(*found, 200),
                       check.wanted);
  if (value != nullptr) *value = *number;
  if (!(std::abs(*number - check.wanted) <= check.tolerance))
    return fmt::format(
        "{}found {:.9g}; expected {:.9g}, as was sent: the instrument does not take "
        "this value",
        of_what, *number, check.wanted);
  return "";
}

}  // namespace tofsmith
