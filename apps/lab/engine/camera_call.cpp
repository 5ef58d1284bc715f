// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "camera_call.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith::lab {

namespace {

/// A key that most people change, and within what; all others are for experts.
struct UsualRange {
  std::string_view key;
  double low, high;  ///< 0, 0: no number
};
constexpr std::array usual_ranges = {
    UsualRange{"fundamental_frequency_hz", 1e6, 3e8},
    UsualRange{"exposure_s", 1e-5, 1.0},
    UsualRange{"samples", 60, 2000},
    UsualRange{"light.peak_factor", 1, 60},
    UsualRange{"light.binary", 0, 0},
    UsualRange{"light.impulse_response.kind", 0, 0},
    UsualRange{"light.impulse_response.f_max_hz", 1e7, 3e9},
    UsualRange{"light.impulse_response.cutoff_hz", 1e7, 3e9},
    UsualRange{"sensor.taps", 1, 4},
    UsualRange{"sensor.binary", 0, 0},
    UsualRange{"sensor.impulse_response.kind", 0, 0},
    UsualRange{"sensor.impulse_response.f_max_hz", 1e7, 3e9},
    UsualRange{"sensor.impulse_response.cutoff_hz", 1e7, 3e9},
    UsualRange{"sensor.read_noise_e", 0, 100},
    UsualRange{"sensor.noise", 0, 0},
    UsualRange{"sensor.modulation_contrast", 0.1, 1},
    UsualRange{"sensor.readout", 0, 0},
    UsualRange{"operating.signal_e_per_s", 1e3, 1e7},
    UsualRange{"operating.ambient_e_per_s", 1e2, 1e8},
    UsualRange{"operating.error", 0, 0},
    UsualRange{"operating.albedo", 0.05, 1},
};

/// The unit that a key ends with, as people write it; "" of a plain number.
std::string_view unit_of(std::string_view key) {
  // The longer ending first: electrons per second are no seconds.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 17> units = {{
      {"_e_per_s", "e/s"},
      {"_e_per_dn", "e/DN"},
      {"_w_per_m2_nm", "W/m2/nm"},
      {"_m_per_c", "m/degree C"},
      {"_per_c", "1/degree C"},
      {"_hz", "Hz"},
      {"_px", "px"},
      {"_deg", "degrees"},
      {"_klux", "klx"},
      {"_bits", "bits"},
      {"_dn", "DN"},
      {"_s", "s"},
      {"_e", "e"},
      {"_m", "m"},
      {"_w", "W"},
      {"_c", "degrees C"},
      {"_points", "points"},
  }};
  for (const auto& [ending, unit] : units)
    if (key.ends_with(ending)) return unit;
  return "";
}

/// The first number after `at` in a rule, such as the 24 of "1 .. 24".
std::optional<double> number_after(std::string_view text, std::size_t at) {
  at = std::min(text.find_first_not_of(' ', at), text.size());
  text = text.substr(at, std::min(text.find_first_not_of("0123456789.-e^", at), text.size()) - at);
  while (text.ends_with('.')) text.remove_suffix(1);
  const std::size_t power = text.find('^');
  // JSON's numbers are the same in every locale and every standard library.
  const Json number = Json::parse(text.substr(0, power), nullptr, false);
  if (!number.is_number()) return std::nullopt;
  if (power == std::string_view::npos) return number.get<double>();
  const Json exponent = Json::parse(text.substr(power + 1), nullptr, false);
  if (!exponent.is_number()) return std::nullopt;
  return std::pow(number.get<double>(), exponent.get<double>());
}

/// The bounds that a comment ends with: "> 0", ">= 1", "(0, 1]", "1 .. 24".
std::pair<std::optional<double>, std::optional<double>> bounds_of(std::string_view doc) {
  std::pair<std::optional<double>, std::optional<double>> bounds;
  if (const std::size_t dots = doc.find(" .. "); dots != std::string_view::npos) {
    const std::size_t before = doc.find_last_not_of("0123456789.", dots - 1);
    bounds.first = number_after(doc, before == std::string_view::npos ? 0 : before + 1);
    bounds.second = number_after(doc, dots + 4);
  } else if (const std::size_t open = doc.find_last_of("(["); open != std::string_view::npos) {
    const std::size_t comma = doc.find(',', open);
    if (comma == std::string_view::npos) return bounds;
    bounds.first = number_after(doc, open + 1);
    bounds.second = number_after(doc, comma + 1);
    if (!bounds.first || !bounds.second) return {};
  } else if (const std::size_t above = doc.find('>'); above != std::string_view::npos) {
    bounds.first = number_after(doc, above + (doc.substr(above).starts_with(">=") ? 2 : 1));
  }
  return bounds;
}

/// The value of "light.peak_factor" in a camera's document; null: it has none.
Json value_at(const Json& document, std::string_view key) {
  const Json* at = &document;
  for (;;) {
    const std::size_t dot = key.find('.');
    const auto found = at->find(std::string(key.substr(0, dot)));
    if (found == at->end()) return nullptr;
    if (dot == std::string_view::npos) return *found;
    at = &*found;
    if (!at->is_object()) return nullptr;
    key.remove_prefix(dot + 1);
  }
}

void add_bounds(Json& field, std::string_view doc, const UsualRange* usual) {
  if (field["type"] != "number" && field["type"] != "integer" && field["type"] != "list") return;
  const auto [low, high] = bounds_of(doc);
  if (low) field["low"] = *low;
  if (high) field["high"] = *high;
  double from = 0.0, to = 1.0;
  if (usual != nullptr && usual->high > usual->low) {
    from = usual->low;
    to = usual->high;
  } else if (low && high) {
    from = *low;
    to = *high;
  } else if (const Json& value = field["value"]; value.is_number() && value.get<double>() > 0.0) {
    from = value.get<double>() / 10.0;
    to = value.get<double>() * 10.0;
  } else if (field["unit"] == "s") {
    to = 1e-8;
  }
  field["usual"] = {from, to};
  field["log"] = from > 0.0 && to / from >= 50.0;
}

Json field_json(const CameraKey& described, const Json& document, const Json& defaults) {
  const std::string& key = described.key;
  const std::size_t dot = key.rfind('.');
  const std::string_view doc = doc_of_camera_key(key);
  const auto* const usual = std::find_if(usual_ranges.begin(), usual_ranges.end(),
                                         [&](const UsualRange& range) { return range.key == key; });
  const bool is_usual = usual != usual_ranges.end();
  Json field = {{"key", key},
                {"section", dot == std::string::npos ? "" : key.substr(0, dot)},
                {"unit", unit_of(key)},
                {"doc", doc},
                {"type", name_of(described.type)},
                {"value", value_at(document, key)},
                {"default", value_at(defaults, key)},
                {"expert", !is_usual}};
  if (!described.words.empty()) field["choices"] = described.words;
  add_bounds(field, doc, is_usual ? usual : nullptr);
  return field;
}

}  // namespace

Answer camera_answer(const Camera& camera) {
  const Json document = Json::parse(camera_to_json(camera));
  Camera blank;
  blank.operating = paper_operating_range();
  const Json defaults = Json::parse(camera_to_json(blank));
  Answer answer;
  answer["name"] = camera.name;
  answer["toml"] = camera_to_toml(camera);
  answer["range_m"] = camera.range_m();
  Json& fields = answer["fields"] = Json::array();
  for (const CameraKey& key : describe_camera_keys(camera))
    if (key.applies && key.type != CameraKeyType::table)
      fields.push_back(field_json(key, document, defaults));
  answer["warnings"] = Json::array();
  return answer;
}

}  // namespace tofsmith::lab
