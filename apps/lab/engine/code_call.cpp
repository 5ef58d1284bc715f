// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "code_call.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/decoding_table_file.hpp"

namespace tofsmith::lab {

namespace {

/// Returns the value of a dotted key such as "light.peak_factor" in a document; null if it is not
/// set.
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

/// Returns the type of a field on the page, where several value types are lists.
std::string_view type_of(const KeyDescription& described, const Json& value) {
  switch (described.type) {
    case ValueType::numbers:
    case ValueType::integers:
    case ValueType::number_pair:
    case ValueType::raw_numbers:
      return "list";
    case ValueType::number_or_list:
      return value.is_array() ? "list" : "number";
    case ValueType::number_or_word:
      return "number";
    case ValueType::path:
      return "text";
    default:
      return name_of(described.type);
  }
}

void add_bounds(Json& field, const Key& key) {
  if (field["type"] != "number" && field["type"] != "integer" && field["type"] != "list") return;
  const bool has_low = std::isfinite(key.range.low), has_high = std::isfinite(key.range.high);
  if (has_low) field["low"] = key.range.low;
  if (has_high) field["high"] = key.range.high;
  double from = 0.0, to = 1.0;
  if (key.usual_high > key.usual_low) {
    from = key.usual_low;
    to = key.usual_high;
  } else if (has_low && has_high) {
    from = key.range.low;
    to = key.range.high;
  } else if (const Json& value = field["value"]; value.is_number() && value.get<double>() > 0.0) {
    from = value.get<double>() / 10.0;
    to = value.get<double>() * 10.0;
  } else if (field["unit"] == "s") {
    to = 1e-8;
  }
  field["usual"] = {from, to};
  field["log"] = from > 0.0 && to / from >= 50.0;
}

/// Returns a key in words without its first table and its unit, such as "impulse response cutoff".
std::string label_of(std::string_view key) {
  std::string_view name = key.substr(key.find('.') + 1);
  if (const std::string_view unit = unit_of_key(key); !unit.empty()) {
    std::size_t end = name.rfind('_');
    while (unit_of_key(name.substr(end)) != unit) end = name.rfind('_', end - 1);
    name = name.substr(0, end);
  }
  std::string label(name);
  for (char& c : label)
    if (c == '_' || c == '.') c = ' ';
  return label;
}

Json field_json(const KeyDescription& described, const Json& document, const Json& defaults) {
  const std::string& name = described.name;
  const Key& key = described.key;
  const std::size_t dot = name.rfind('.');
  const Json value = value_at(document, name);
  Json field = {{"key", name},
                {"label", label_of(name)},
                {"section", dot == std::string::npos ? "" : name.substr(0, dot)},
                {"unit", unit_of_key(name)},
                {"doc", key.help},
                {"type", type_of(described, value)},
                {"value", value},
                {"default", value_at(defaults, name)},
                {"expert", !key.is_basic}};
  if (!described.words.empty()) field["choices"] = described.words;
  add_bounds(field, key);
  return field;
}

/// Wraps a position to the period [0, 1).
double wrapped(double position) {
  position -= std::floor(position);
  return position < 1.0 ? position : 0.0;
}

/// Returns [rise, fall, rise, ...], each in [0, 1).
std::vector<double> edges_of(const Waveform& waveform) {
  std::vector<double> edges;
  for (const OnInterval& on : waveform.on_intervals())
    if (on.fall - on.rise < 1.0) {
      edges.push_back(on.rise);
      edges.push_back(wrapped(on.fall));
    }
  return edges;
}

bool is_behind_a_response(const ImpulseResponse& response) {
  return response.kind != ImpulseResponse::Kind::none;
}

/// Returns the share of a table's variance that its three-dimensional curve retains.
double variance_kept(const Eigen::MatrixXd& table, const Eigen::MatrixXd& curve) {
  const auto about_mean = [](const Eigen::MatrixXd& m) {
    return (m.rowwise() - m.colwise().mean()).squaredNorm();
  };
  const double whole = about_mean(table);
  return whole > 0.0 ? std::min(about_mean(curve) / whole, 1.0) : 1.0;
}

Json edges_json(const CodeSet& code, bool is_light) {
  Json edges = Json::array();
  for (int i = 0; i < code.measurements(); ++i)
    edges.push_back(edges_of(is_light ? code.modulation_of(i) : code.demodulation(i)));
  return edges;
}

/// Returns the intervals of a waveform with one edge moved, at most to the neighbouring edges.
/// @param gap  minimum distance between two edges [periods]
std::vector<OnInterval> moved_edge(const Waveform& waveform, std::size_t edge, double position,
                                   double gap) {
  std::vector<OnInterval> on = waveform.on_intervals();
  // Consecutive edges, not wrapped at the end of the period.
  std::vector<double> line;
  for (const OnInterval& interval : on) {
    line.push_back(interval.rise);
    line.push_back(interval.fall);
  }
  const double before = edge == 0 ? line.back() - 1.0 : line[edge - 1];
  const double after = edge + 1 == line.size() ? line.front() + 1.0 : line[edge + 1];
  double shift = wrapped(position - line[edge] + 0.5) - 0.5;
  shift = std::min(shift, after - gap - line[edge]);
  shift = std::max(shift, before + gap - line[edge]);
  line[edge] += shift;
  for (std::size_t i = 0; i < on.size(); ++i) {
    const double rise = wrapped(line[2 * i]);
    on[i] = {rise, rise + (line[2 * i + 1] - line[2 * i])};
  }
  std::sort(on.begin(), on.end(),
            [](const OnInterval& a, const OnInterval& b) { return a.rise < b.rise; });
  return on;
}

/// Returns true if b equals 1 - a up to rounding.
bool are_complements(const Waveform& a, const Waveform& b, int samples) {
  const Eigen::VectorXd sum = a.cell_averages(samples) + b.cell_averages(samples);
  return (sum.array() - 1.0).abs().maxCoeff() < 1e-9;
}

}  // namespace

Answer camera_answer(const Camera& camera) {
  const Json document = Json::parse(camera_to_json(camera));
  Camera blank;
  blank.operating = default_operating_range();
  const Json defaults = Json::parse(camera_to_json(blank));
  Answer answer;
  answer["name"] = camera.name;
  answer["toml"] = camera_to_toml(camera);
  answer["range_m"] = camera.range_m();
  Json& fields = answer["fields"] = Json::array();
  for (const KeyDescription& described : describe_camera_keys(camera))
    if (described.key.applies && described.type != ValueType::table)
      fields.push_back(field_json(described, document, defaults));
  return answer;
}

Answer code_answer(const CodeSet& code, const Camera& camera) {
  const ForwardModel model(code, camera);
  const ActualCode actual = actual_code(code, camera);
  const int samples = code.samples();
  const double f0_hz = camera.fundamental_frequency_hz;
  Eigen::MatrixXd light(samples, code.measurements()), gates = light, light_behind = light,
                                                       gates_behind = light;
  for (int i = 0; i < code.measurements(); ++i) {
    const Waveform& m = actual.modulation[static_cast<std::size_t>(code.exposure_of(i))];
    const Waveform& d = actual.demodulation[static_cast<std::size_t>(i)];
    light.col(i) = m.cell_averages(samples);
    gates.col(i) = d.cell_averages(samples);
    light_behind.col(i) = arm_output(m, camera.light.impulse_response, f0_hz, samples);
    gates_behind.col(i) = arm_output(d, camera.sensor.impulse_response, f0_hz, samples);
  }
  const Eigen::MatrixXd table = model.correlation_table(samples);
  const Eigen::MatrixXd fine_table = model.correlation_table(8 * samples);
  const Eigen::MatrixXd curve = coding_curve_in_space(table);

  Answer answer;
  answer["name"] = code.name();
  answer["samples"] = samples;
  answer["exposures"] = code.exposures();
  answer["taps"] = code.taps();
  answer["measurements"] = model.measurements();
  answer["peak"] = code.peak();
  answer["range_m"] = camera.range_m();
  // The same values as in `tofsmith codes`.
  answer["coding_curve_length"] = coding_curve_length(fine_table);
  answer["coding_curve_rank"] = coding_curve_rank(fine_table);
  answer["harmonics_99_percent"] = harmonics_used(fine_table);
  answer["curve_variance_kept"] = variance_kept(table, curve);
  answer["light_edges"] = edges_json(code, true);
  answer["gate_edges"] = edges_json(code, false);
  answer.add_columns("light", light);
  answer.add_columns("gates", gates);
  if (is_behind_a_response(camera.light.impulse_response))
    answer.add_columns("light_behind", light_behind);
  if (is_behind_a_response(camera.sensor.impulse_response))
    answer.add_columns("gates_behind", gates_behind);
  answer.add_columns("correlation", table);
  const Eigen::MatrixXd rows = curve.transpose();
  answer.add("curve", std::vector<double>(rows.data(), rows.data() + rows.size()),
             {static_cast<std::size_t>(curve.rows()), static_cast<std::size_t>(curve.cols())});
  Json& notes = answer["notes"] = Json::array();
  if (const auto note = ambiguity_note(make_decoding_table(model, camera))) notes.push_back(*note);
  return answer;
}

CodeSet with_edge_moved(const CodeSet& code, const Camera& camera, const EdgeMove& move) {
  for_each_field(move, [](const auto& field) {
    require(field.value.has_value(), field.name, "nothing", "expected a value");
  });
  require(*move.measurement < code.measurements(), "measurement", *move.measurement,
          fmt::format("expected 0 to {}", code.measurements() - 1));
  std::vector<Waveform> light, gates;
  for (int e = 0; e < code.exposures(); ++e) light.push_back(code.modulation(e));
  for (int i = 0; i < code.measurements(); ++i) gates.push_back(code.demodulation(i));
  const auto exposure = static_cast<std::size_t>(code.exposure_of(*move.measurement));
  const auto gate = static_cast<std::size_t>(*move.measurement),
             edge = static_cast<std::size_t>(*move.edge);
  const bool is_light = move.arm == EdgeArm::light;
  Waveform& waveform = is_light ? light[exposure] : gates[gate];
  const std::vector<double> edges = edges_of(waveform);
  require(!edges.empty(), name_of(*move.arm), *move.measurement,
          "has no edges, because the waveform is not binary");
  require(edge < edges.size(), "edge", edge, fmt::format("expected 0 to {}", edges.size() - 1));

  const double gap = 0.25 / code.samples();
  const std::vector<OnInterval> on = moved_edge(waveform, edge, *move.position, gap);
  if (is_light) {
    double duty = 0.0;
    for (const OnInterval& interval : on) duty += interval.fall - interval.rise;
    waveform = Waveform::binary(on, std::min(1.0 / duty, camera.light.peak_factor));
  } else {
    const std::size_t other = gate ^ 1u;
    const bool mirrors =
        code.taps() == 2 && are_complements(gates[gate], gates[other], code.samples());
    waveform = Waveform::binary(on, waveform.level());
    if (mirrors) gates[other] = waveform.complement();
  }
  constexpr std::string_view mark = "-edited";
  const std::string name =
      code.name().ends_with(mark) ? code.name() : code.name() + std::string(mark);
  CodeSet edited = CodeSet::create(name, code.samples(), code.taps(), light, gates)
                       .with_exposure_shares(code.exposure_shares());
  if (code.is_signed()) edited = edited.with_signed_weights();
  edited.provenance = code.provenance;
  edited.provenance.method = "edited";
  edited.provenance.residuals.clear();
  edited.provenance.depth_error_m = 0.0;
  require_fits(edited, camera);
  return edited;
}

}  // namespace tofsmith::lab
