// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/design_directory.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "core/shared/hash.hpp"
#include "io/documents/shared/document_text.hpp"
#include "io/shared/read_file.hpp"
#include "io/text/field_json.hpp"
#include "io/text/shared/field_key.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

Json details_json(const Candidate& candidate) {
  Json details = {{"message", candidate.message}};
  if (candidate.search) details["search"] = fields_json(*candidate.search);
  for (Eigen::Index k = 0; k < candidate.target.cols(); ++k) {
    const Eigen::VectorXd column = candidate.target.col(k);
    details["target"].push_back(std::vector<double>(column.begin(), column.end()));
  }
  if (candidate.target.size() == 0) return details;
  for (const MeasurementReport& m : candidate.per_measurement) {
    Json history = Json::array();
    for (const FactorizeIteration& iteration : m.history) history.push_back(row_json(iteration));
    details["histories"].push_back(std::move(history));
  }
  return details;
}

void read_details(const ValueReader& details, int samples, Candidate& candidate) {
  candidate.message = details.member("message").text();
  const std::size_t measurements = candidate.per_measurement.size();
  if (measurements == 0) return;
  if (const auto search = details.optional_member("search"))
    candidate.search = fields_from_json<SearchRecord>(*search);
  if (!details.optional_member("target")) return;
  const auto columns = details.member("target").elements(measurements, "one per measurement");
  candidate.target.resize(samples, std::ssize(columns));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto values =
        columns[k].elements(static_cast<std::size_t>(samples), "one per sample of the camera");
    for (std::size_t n = 0; n < values.size(); ++n)
      candidate.target(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(k)) =
          values[n].number();
  }
  const auto histories = details.member("histories").elements(measurements, "one per measurement");
  for (std::size_t k = 0; k < histories.size(); ++k)
    for (const ValueReader& entry : histories[k].elements())
      candidate.per_measurement[k].history.push_back(row_from_json<FactorizeIteration>(entry));
}

/// Stores measured responses as samples, independent of their files.
Camera self_contained(Camera camera) {
  camera.light.impulse_response.file.clear();
  camera.sensor.impulse_response.file.clear();
  return camera;
}

/// Hash of all inputs that determine a designed code.
std::string design_key(const Camera& camera, DesignOptions options) {
  // Irrelevant: codes are evaluated again and named by their number of exposures.
  options.trials = 0;
  options.outlier_threshold_m = 0.0;
  if (!options.exposures.empty()) options.exposures.assign(1, 0);  // = {0} makes GCC 14 warn
  std::string key = TOFSMITH_VERSION + camera_to_json(self_contained(camera));
  append_key(key, options);
  return fmt::format("{:016x}", fnv1a_64(key));
}

Document read_json(const fs::path& path) { return parse_json(read_text_file(path), path.string()); }

fs::path code_path(const fs::path& directory, const std::string& name) {
  return directory / "codes" / (file_name_of(name) + ".code.json");
}

/// A code must have its file's name and fit the camera.
void check_code(const Candidate& candidate, const std::string& name, const Camera& camera,
                const fs::path& path) {
  const std::size_t reported = candidate.per_measurement.size();
  if (candidate.code.name() != name)
    throw IoError(path.string(), fmt::format("found the code \"{}\"; expected \"{}\"",
                                             candidate.code.name(), name));
  if (reported != 0 && reported != static_cast<std::size_t>(candidate.code.exposures()) &&
      reported != static_cast<std::size_t>(candidate.code.measurements()))
    throw IoError(path.string(), fmt::format("found {} reports per measurement of {}; expected {}",
                                             reported, name, candidate.code.measurements()));
  try {
    require_fits(candidate.code, camera);
  } catch (const std::invalid_argument& error) {
    throw IoError(path.string(),
                  fmt::format("does not fit the camera in the same directory: {}", error.what()));
  }
}

fs::path finished_path(const fs::path& directory, const std::string& name) {
  return directory / "finished" / (file_name_of(name) + ".json");
}

Json finished_json(const Candidate& candidate) {
  return {{"method", candidate.method},
          {"iterations", candidate.iterations},
          {"seconds", candidate.seconds},
          {"per_measurement", measurements_json(candidate)},
          {"code", Json::parse(code_to_json(candidate.code))},
          {"details", details_json(candidate)}};
}

Candidate finished_from_json(const ValueReader& json, const fs::path& path, const std::string& name,
                             const Camera& camera) {
  Candidate candidate{
      .code = code_from_json(json.member("code")),
      .method = json.member("method").text(),
      .iterations = json.member("iterations").integer(0, std::numeric_limits<int>::max()),
      .seconds = json.member("seconds").number(),
      .per_measurement = measurements_from_json(json)};
  check_code(candidate, name, camera, path);
  read_details(json.member("details"), camera.samples, candidate);
  return candidate;
}

/// Returns none if the candidates were designed from other inputs.
std::vector<Candidate> read_finished(const fs::path& path, const std::string& key,
                                     const std::string& name, const Camera& camera) {
  const Document document = read_json(path);
  const ValueReader json(document);
  std::vector<Candidate> candidates;
  if (json.member("key").text() != key) return candidates;
  for (const ValueReader& entry : json.member("candidates").elements())
    candidates.push_back(finished_from_json(entry, path, name, camera));
  return candidates;
}

}  // namespace

DesignDirectory::DesignDirectory(fs::path path) : path_(std::move(path)) {}

bool DesignDirectory::holds_design() const { return fs::exists(path_ / "design.json"); }

DesignStore DesignDirectory::store(const Camera& camera, const DesignOptions& options) const {
  make_output_directory(path_ / "finished");
  const std::string key = design_key(camera, options);
  return {
      .load = [key, camera, directory = path_](const std::string& name) -> std::vector<Candidate> {
        const fs::path path = finished_path(directory, name);
        if (!fs::exists(path)) return {};
        try {
          return read_finished(path, key, name, camera);
        } catch (const IoError&) {
          return {};  // damaged: design the code again
        }
      },
      .save =
          [key, directory = path_](const std::string& name,
                                   const std::vector<Candidate>& candidates) {
            Json json = {{"key", key}, {"candidates", Json::array()}};
            for (const Candidate& candidate : candidates)
              json["candidates"].push_back(finished_json(candidate));
            write_file_atomically(finished_path(directory, name), json.dump(1),
                                  OutputPolicy::overwrite);
          }};
}

void DesignDirectory::write(const Camera& camera, const DesignResult& result,
                            const DesignOptions& options, OutputPolicy policy) const {
  make_output_directory(path_ / "codes");
  std::error_code ignored;  // design.json marks a complete design
  if (policy == OutputPolicy::overwrite) fs::remove(path_ / "design.json", ignored);
  write_file_atomically(path_ / "camera.toml", camera_to_toml(self_contained(camera)), policy);
  for (const Candidate& c : result.candidates)
    write_code(code_path(path_, c.code.name()), c.code, policy);
  Json details = Json::object();
  for (const Candidate& c : result.candidates)
    if (c.is_designed()) details[c.code.name()] = details_json(c);
  write_file_atomically(path_ / "details.json", details.dump(1), policy);
  // Last, because its presence marks a complete design.
  write_file_atomically(path_ / "design.json", design_document(camera, result, options), policy);
}

DesignRecord DesignDirectory::read() const {
  const fs::path path = path_ / "design.json", details_path = path_ / "details.json";
  const Document document_json = read_json(path), details_json = read_json(details_path);
  const ValueReader document(document_json), details(details_json);
  if (const ValueReader version = document.member("tofsmith"); version.text() != TOFSMITH_VERSION)
    version.mistyped("\"" TOFSMITH_VERSION
                     "\"; read the design with the version that wrote it, or repeat it");
  DesignRecord record{read_camera_toml(path_ / "camera.toml"), {}};
  DesignResult& result = record.result;
  const std::string best = document.member("best").text();
  for (const ValueReader& entry : document.member("codes").elements()) {
    const std::string name = entry.member("name").text();
    if (result.find(name)) entry.fail(fmt::format("contains the code \"{}\" twice", name));
    const fs::path code_file = code_path(path_, name);
    Candidate candidate{.code = read_code(code_file),
                        .method = entry.member("method").text(),
                        .error = depth_error_from_json(entry, document),
                        .rotation_bin = entry.member("rotation_bin").integer(0, 65536),
                        .per_measurement = measurements_from_json(entry)};
    check_code(candidate, name, record.camera, code_file);
    if (candidate.error.points.size() != record.camera.operating.points().size())
      entry.member("points").fail(
          fmt::format("found {} operating points; expected {}, as in camera.toml",
                      candidate.error.points.size(), record.camera.operating.points().size()));
    if (candidate.is_designed()) {
      candidate.iterations = entry.member("iterations").integer(0, std::numeric_limits<int>::max());
      candidate.seconds = entry.member("seconds").number();
      read_details(details.member(name), record.camera.samples, candidate);
    }
    if (const auto robustness = entry.optional_member("robustness"))
      candidate.robustness = fields_from_json<RobustnessReport>(*robustness);
    if (record.camera.operating.multipath)
      candidate.multipath = fields_from_json<OperatingMultipathReport>(entry.member("multipath"));
    if (record.camera.operating.interference)
      candidate.interference = fields_from_json<InterferenceReport>(entry.member("interference"));
    if (record.camera.operating.velocity_m_per_s)
      candidate.exposure_order = fields_from_json<ExposureOrder>(entry.member("exposure_order"));
    if (name == best) result.best = result.candidates.size();
    result.candidates.push_back(std::move(candidate));
  }
  if (!result.find(best)) document.member("best").mistyped("the name of one of the codes");
  for (const ValueReader& reason : document.member("left_out").elements())
    result.left_out.push_back(reason.text());
  for (const ValueReader& sentence : document.member("explanation").elements())
    result.explanation.push_back(sentence.text());
  return record;
}

void write_requirements(const std::filesystem::path& directory, const Camera& camera,
                        const Requirements& found, const RequirementOptions& options,
                        OutputPolicy policy) {
  make_output_directory(directory);
  write_code(directory / "as_it_is.code.json", found.code, policy);
  for (const Sufficiency& s : found.varied) {
    if (!s.factor) continue;
    const std::string name(name_of(s.quantity));
    write_code(directory / (name + ".code.json"), s.code, policy);
    write_file_atomically(directory / (name + ".camera.toml"),
                          camera_to_toml(with_scaled(camera, s.quantity, *s.factor)), policy);
  }
  write_file_atomically(directory / "requirements.json",
                        requirements_document(camera, found, options) + "\n", policy);
}

}  // namespace tofsmith
