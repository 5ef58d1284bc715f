// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/code_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "io/documents/shared/document_text.hpp"
#include "io/text/field_json.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::string_view format_name = "tofsmith-code";
constexpr int format_version = 1;
constexpr int max_samples = 65536;    // as for cameras
constexpr int max_harmonic = 2048;    // as for families
constexpr int max_measurements = 64;  // limit of decoders
constexpr double tolerance = 1e-9;    // as for CodeSet

/// Writes nonzero harmonics as [n, Re c_n, Im c_n].
OrderedJson cosines_to_json(const Eigen::VectorXcd& coefficients) {
  OrderedJson harmonics = OrderedJson::array();
  for (Eigen::Index n = 1; n < coefficients.size(); ++n)
    if (coefficients[n] != 0.0)
      harmonics.push_back({n, coefficients[n].real(), coefficients[n].imag()});
  return {{"kind", "cosines"}, {"mean", coefficients[0].real()}, {"harmonics", harmonics}};
}

OrderedJson waveform_to_json(const Waveform& waveform, bool is_signed = false) {
  if (!waveform.is_binary() && !waveform.is_sampled())
    return cosines_to_json((is_signed ? waveform.scaled(-1.0, 2.0) : waveform).coefficients());
  if (!waveform.is_binary()) {
    Eigen::VectorXd samples = waveform.samples();
    if (is_signed) samples = 2.0 * samples.array() - 1.0;
    return {{"kind", "sampled"}, {"values", std::vector<double>(samples.begin(), samples.end())}};
  }
  OrderedJson on = OrderedJson::array();
  for (const OnInterval& interval : waveform.on_intervals())
    on.push_back(std::vector<double>{interval.rise, interval.fall});
  return {{"kind", "binary"}, {"level", waveform.level()}, {"on", std::move(on)}};
}

OrderedJson provenance_to_json(const Provenance& provenance) {
  for (const double residual : provenance.residuals)
    require(std::isfinite(residual), "provenance.residuals", residual, "must be finite");
  require(std::isfinite(provenance.depth_error_m), "provenance.depth_error_m",
          provenance.depth_error_m, "must be finite");
  return {{"method", provenance.method},       {"camera", provenance.camera},
          {"seed", provenance.seed},           {"version", provenance.version},
          {"residuals", provenance.residuals}, {"depth_error_m", provenance.depth_error_m}};
}

Waveform read_sampled(const ValueReader& json, int samples, double lowest, double highest) {
  json.only({"kind", "values"});
  const auto values =
      json.member("values").elements(static_cast<std::size_t>(samples), "as specified by /samples");
  Eigen::VectorXd read(samples);
  for (int n = 0; n < samples; ++n)
    read[n] = values[static_cast<std::size_t>(n)].number(lowest, highest, tolerance);
  return Waveform::sampled(std::move(read));
}

Waveform read_binary(const ValueReader& json, double highest) {
  json.only({"kind", "level", "on"});
  const ValueReader on_place = json.member("on");
  std::vector<OnInterval> on;
  for (const ValueReader& interval : on_place.elements()) {
    const auto edges = interval.elements(2, "[rise, fall]");
    on.push_back({edges[0].number(), edges[1].number()});
  }
  const ValueReader level_place = json.member("level");
  const double level = level_place.number(0.0, highest, tolerance);
  if (level <= 0.0) level_place.mistyped("a number > 0");
  try {
    return Waveform::binary(std::move(on), level);
  } catch (const std::invalid_argument& error) {
    on_place.fail(error.what());
  }
}

/// Reads x(t) = mean + 2 Re sum of c_n exp(2 pi i n t).
/// @param lowest, highest  limits of x
Waveform read_cosines(const ValueReader& json, double lowest, double highest) {
  json.only({"kind", "mean", "harmonics"});
  Eigen::VectorXcd coefficients(1);
  coefficients[0] = json.member("mean").number(lowest, highest, tolerance);
  for (const ValueReader& entry : json.member("harmonics").elements()) {
    const auto fields = entry.elements(3, "[n, real part, imaginary part]");
    const int n = fields[0].integer(1, max_harmonic);
    const Eigen::Index old_size = coefficients.size();
    if (n >= old_size) {
      coefficients.conservativeResize(n + 1);
      coefficients.tail(n + 1 - old_size).setZero();
    }
    coefficients[n] = {fields[1].number(), fields[2].number()};
  }
  Waveform waveform = Waveform::cosines(std::move(coefficients));
  if (waveform.minimum() < lowest - tolerance || waveform.peak() > highest + tolerance)
    json.mistyped(fmt::format("values in [{}, {}]", lowest, highest));
  return waveform;
}

Waveform read_waveform(const ValueReader& json, int samples, double highest) {
  const ValueReader kind = json.member("kind");
  if (kind.text() == "binary") return read_binary(json, highest);
  if (kind.text() == "sampled") return read_sampled(json, samples, 0.0, highest);
  if (kind.text() == "cosines") return read_cosines(json, 0.0, highest);
  kind.mistyped("\"binary\", \"sampled\" or \"cosines\"");
}

/// Reads the drive of a mixer: (w + 1) / 2 for sampled weights w; 1 or 0 for binary weights.
Waveform read_drive(const ValueReader& json, int samples) {
  const ValueReader kind = json.member("kind");
  if (kind.text() == "sampled")
    return Waveform::sampled(
        (0.5 * (read_sampled(json, samples, -1.0, 1.0).samples().array() + 1.0)).max(0.0).min(1.0));
  if (kind.text() == "cosines") return read_cosines(json, -1.0, 1.0).scaled(0.5, 0.5);
  return read_waveform(json, samples, 1.0);
}

Eigen::MatrixXd read_rows(const ValueReader& json, int samples, int count) {
  constexpr double any = std::numeric_limits<double>::max();
  const auto list = json.elements(static_cast<std::size_t>(count), "as specified by /taps");
  Eigen::MatrixXd rows(samples, count);
  for (int k = 0; k < count; ++k) {
    const ValueReader& row = list[static_cast<std::size_t>(k)];
    if (const ValueReader kind = row.member("kind"); kind.text() != "sampled")
      kind.mistyped("\"sampled\" for rows");
    rows.col(k) = read_sampled(row, samples, -any, any).samples();
  }
  return rows;
}

Provenance read_provenance(const ValueReader& json) {
  json.only({"method", "camera", "seed", "version", "residuals", "depth_error_m"});
  Provenance read;
  if (const auto method = json.optional_member("method")) read.method = method->text();
  if (const auto camera = json.optional_member("camera")) read.camera = camera->text();
  if (const auto seed = json.optional_member("seed")) read.seed = seed->unsigned_integer();
  if (const auto version = json.optional_member("version")) read.version = version->text();
  if (const auto residuals = json.optional_member("residuals"))
    for (const ValueReader& residual : residuals->elements())
      read.residuals.push_back(residual.number());
  if (const auto error = json.optional_member("depth_error_m"))
    read.depth_error_m = error->number();
  return read;
}

void check_format(const ValueReader& json) {
  const auto format = json.optional_member("format");
  if (!format)
    json.fail(fmt::format("found no member \"format\"; expected \"format\": \"{}\"", format_name));
  if (format->text() != format_name) format->mistyped(fmt::format("\"{}\"", format_name));
  const ValueReader version = json.member("version");
  if (version.integer(1, std::numeric_limits<int>::max()) != format_version)
    version.mistyped(fmt::format("{}: a newer tofsmith wrote this file", format_version));
}

CodeSet with_shares(const ValueReader& json, const CodeSet& code) {
  std::vector<double> shares;
  for (const ValueReader& share :
       json.elements(static_cast<std::size_t>(code.exposures()), "one per exposure"))
    shares.push_back(share.number());
  try {
    return code.with_exposure_shares(std::move(shares));
  } catch (const InvalidArgument& error) {
    json.fail(error.what());
  }
}

/// Returns the waveform named by a field of CodeSet::create() ("demodulation 3 minimum").
ValueReader place_of_field(const ValueReader& json, std::string_view field) {
  for (const std::string_view list : {"modulation", "demodulation"}) {
    if (!field.starts_with(list)) continue;
    std::size_t index = 0;
    const char* digits = field.data() + std::min(list.size() + 1, field.size());
    std::from_chars(digits, field.data() + field.size(), index);
    return json.member(list).elements().at(index);
  }
  return json;
}

}  // namespace

std::string code_to_json(const CodeSet& code) {
  OrderedJson json = {{"format", format_name},         {"version", format_version},
                      {"name", code.name()},           {"samples", code.samples()},
                      {"exposures", code.exposures()}, {"taps", code.taps()}};
  OrderedJson modulation = OrderedJson::array(), demodulation = modulation;
  for (int e = 0; e < code.exposures(); ++e)
    modulation.push_back(waveform_to_json(code.modulation(e)));
  for (int i = 0; i < code.measurements(); ++i)
    demodulation.push_back(waveform_to_json(code.demodulation(i), code.is_signed()));
  if (code.is_rows()) json["rows"] = true;
  if (code.is_signed()) json["signed"] = true;
  if (!code.exposure_shares().empty()) json["exposure_shares"] = code.exposure_shares();
  json["modulation"] = std::move(modulation);
  json["demodulation"] = std::move(demodulation);
  json["provenance"] = provenance_to_json(code.provenance);
  return format_json(json) + "\n";
}

CodeSet code_from_json(const ValueReader& json) {
  check_format(json);
  json.only({"format", "version", "name", "samples", "exposures", "taps", "rows", "signed",
             "exposure_shares", "modulation", "demodulation", "provenance"});
  const std::string name = json.member("name").text();
  const int samples = json.member("samples").integer(2, max_samples);
  const int exposures = json.member("exposures").integer(1, max_measurements);
  const int taps = json.member("taps").integer(1, max_measurements / exposures);

  const auto read_list = [&](const char* member, int count, const char* because, double highest) {
    std::vector<Waveform> list;
    for (const ValueReader& item :
         json.member(member).elements(static_cast<std::size_t>(count), because))
      list.push_back(read_waveform(item, samples, highest));
    return list;
  };
  constexpr double any = std::numeric_limits<double>::infinity();
  auto modulation = read_list("modulation", exposures, "as specified by /exposures", any);
  const auto rows = json.optional_member("rows");
  const bool is_rows = rows && rows->boolean();
  const auto weights_of_both_signs = json.optional_member("signed");
  const bool is_signed = weights_of_both_signs && weights_of_both_signs->boolean();
  if (is_signed && is_rows)
    weights_of_both_signs->fail("is not valid for rows, whose weights are always signed");
  if (is_signed && taps != 1) json.member("taps").mistyped("1 for a mixer");
  std::vector<Waveform> demodulation;
  Eigen::MatrixXd weights;
  if (is_rows) {
    if (exposures != 1) json.member("exposures").mistyped("1 for rows");
    weights = read_rows(json.member("demodulation"), samples, taps);
  } else if (is_signed) {
    for (const ValueReader& item :
         json.member("demodulation")
             .elements(static_cast<std::size_t>(exposures), "as specified by /exposures"))
      demodulation.push_back(read_drive(item, samples));
  } else {
    demodulation = read_list("demodulation", exposures * taps, "/exposures x /taps functions", 1.0);
  }
  try {
    CodeSet code = is_rows ? CodeSet::create_rows(name, std::move(modulation.front()), weights)
                           : CodeSet::create(name, samples, taps, std::move(modulation),
                                             std::move(demodulation));
    if (is_signed) code = code.with_signed_weights();
    if (const auto shares = json.optional_member("exposure_shares"))
      code = with_shares(*shares, code);
    if (const auto provenance = json.optional_member("provenance"))
      code.provenance = read_provenance(*provenance);
    return code;
  } catch (const InvalidArgument& error) {
    place_of_field(json, error.field()).fail(error.what());
  }
}

CodeSet parse_code_json(std::string_view text, std::string_view file) {
  const Document document = parse_json(text, file);
  return code_from_json(ValueReader(document));
}

}  // namespace tofsmith
