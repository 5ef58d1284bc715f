// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/design_directory.hpp"

#include <fmt/format.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "io/json_text.hpp"
#include "io/result_json.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/random.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/code_json.hpp"
#include "tofsmith/io/read_file.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// Targets, histories and messages of a designed code: what only reports need.
Json details_json(const Candidate& candidate) {
  Json details = {{"message", candidate.message}};
  for (Eigen::Index k = 0; k < candidate.target.cols(); ++k) {
    const Eigen::VectorXd column = candidate.target.col(k);
    details["target"].push_back(std::vector<double>(column.begin(), column.end()));
  }
  for (const MeasurementReport& m : candidate.per_measurement) {
    Json history = Json::array();
    for (const FactorizeIteration& i : m.history)
      history.push_back({i.objective, i.relaxed_residual_rms, i.playable_residual_rms});
    details["histories"].push_back(std::move(history));
  }
  return details;
}

void read_details(const nlohmann::json& details, Candidate& candidate) {
  candidate.message = details.at("message");
  if (details.contains("target")) {
    const auto columns = details.at("target").get<std::vector<std::vector<double>>>();
    candidate.target.resize(static_cast<Eigen::Index>(columns.at(0).size()), std::ssize(columns));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (columns[k].size() != columns[0].size())
        throw std::invalid_argument("targets differ in length");
      for (std::size_t n = 0; n < columns[k].size(); ++n)
        candidate.target(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(k)) =
            columns[k][n];
    }
  }
  if (!details.contains("histories")) return;
  std::size_t k = 0;
  for (const auto& history : details.at("histories")) {
    auto& target = candidate.per_measurement.at(k++).history;
    for (const auto& step : history) target.push_back({step.at(0), step.at(1), step.at(2)});
  }
}

/// Everything that determines a designed code, as text.
std::string design_key(const Camera& camera, const DesignOptions& options) {
  const FactorizeOptions& f = options.factorize;
  std::string key = fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}|{}", TOFSMITH_VERSION,
                                camera_to_json(camera), options.seed, options.search_trials,
                                fmt::join(f.total_variation_weights, ","), f.max_iterations,
                                f.objective_tolerance, f.feed_back_projection, f.random_starts,
                                f.structured_starts, f.keep_naive, f.refine_edges, f.refined);
  key += fmt::format("|{}|{}", f.kept, f.seed);
  if (options.target)
    for (const CorrelationTarget& t : options.target->measurements)
      key += fmt::format("|{}", fmt::join(t.samples.begin(), t.samples.end(), ","));
  return fmt::format("{:016x}", combine_keys(std::hash<std::string>{}(key), key.size()));
}

/// Runs `read` and turns a missing or mistyped member into an error that names the file.
template <typename Read>
auto reading(const fs::path& path, Read&& read) {
  try {
    return read();
  } catch (const nlohmann::json::exception& error) {
    throw IoError(path.string(),
                  fmt::format("is not a document of this version of tofsmith ({}); expected what "
                              "`tofsmith design -o` writes",
                              error.what()));
  } catch (const std::logic_error& error) {
    throw IoError(path.string(), error.what());
  }
}

nlohmann::json read_json(const fs::path& path) {
  return parse_json(read_text_file(path), path.string());
}

fs::path code_path(const fs::path& directory, const std::string& name) {
  return directory / "codes" / (name + ".code.json");
}

}  // namespace

DesignDirectory::DesignDirectory(fs::path path) : path_(std::move(path)) {}

void DesignDirectory::create() const {
  for (const fs::path& directory : {path_, path_ / "codes", path_ / "finished"}) {
    std::error_code error;
    fs::create_directories(directory, error);
    if (error || !fs::is_directory(directory))
      throw IoError(directory.string(),
                    fmt::format("cannot create this directory ({}); expected a writable place",
                                error ? error.message() : "a file is in the way"));
  }
}

bool DesignDirectory::holds_design() const { return fs::exists(path_ / "design.json"); }

DesignStore DesignDirectory::store(const Camera& camera, const DesignOptions& options) const {
  create();
  const std::string key = design_key(camera, options);
  const fs::path directory = path_ / "finished";
  return {.load = [key, directory](const std::string& name) -> std::optional<Candidate> {
            const fs::path path = directory / (name + ".json");
            if (!fs::exists(path)) return std::nullopt;
            const nlohmann::json json = read_json(path);
            return reading(path, [&]() -> std::optional<Candidate> {
              if (json.at("key") != key) return std::nullopt;
              Candidate candidate{.code = parse_code_json(json.at("code").dump(), path.string()),
                                  .method = json.at("method"),
                                  .iterations = json.at("iterations"),
                                  .seconds = json.at("seconds"),
                                  .per_measurement = measurements_from_json(json)};
              read_details(json.at("details"), candidate);
              return candidate;
            });
          },
          .save =
              [key, directory](const Candidate& candidate) {
                const Json json = {
                    {"key", key},
                    {"method", candidate.method},
                    {"iterations", candidate.iterations},
                    {"seconds", candidate.seconds},
                    {"per_measurement", measurements_json(candidate.per_measurement)},
                    {"code", Json::parse(code_to_json(candidate.code))},
                    {"details", details_json(candidate)}};
                write_file_atomically(directory / (candidate.code.name() + ".json"), json.dump(1),
                                      OutputPolicy::overwrite);
              }};
}

void DesignDirectory::write(const Camera& camera, const DesignResult& result,
                            const DesignOptions& options, OutputPolicy policy) const {
  create();
  write_file_atomically(path_ / "camera.toml", camera_to_toml(camera), policy);
  for (const Candidate& c : result.candidates)
    write_code(code_path(path_, c.code.name()), c.code, policy);
  Json details = Json::object();
  for (const Candidate& c : result.candidates)
    if (!c.per_measurement.empty()) details[c.code.name()] = details_json(c);
  write_file_atomically(path_ / "details.json", details.dump(1), policy);
  // Last, since its presence says that the design is complete.
  write_file_atomically(path_ / "design.json", design_document(camera, result, options), policy);
}

DesignRecord DesignDirectory::read() const {
  const fs::path path = path_ / "design.json";
  const nlohmann::json document = read_json(path);
  const nlohmann::json details = read_json(path_ / "details.json");
  DesignRecord record{read_camera_toml(path_ / "camera.toml"), {}};
  reading(path, [&] {
    const std::string best = document.at("best");
    for (const auto& entry : document.at("codes")) {
      const std::string name = entry.at("name");
      Candidate candidate{.code = read_code(code_path(path_, name)),
                          .method = entry.at("method"),
                          .error = depth_error_from_json(entry, document),
                          .rotation_bin = entry.at("rotation_bin"),
                          .iterations = entry.value("iterations", 0),
                          .seconds = entry.value("seconds", 0.0),
                          .per_measurement = measurements_from_json(entry)};
      if (details.contains(name)) read_details(details.at(name), candidate);
      if (name == best) record.result.best = record.result.candidates.size();
      record.result.candidates.push_back(std::move(candidate));
    }
    if (record.result.candidates.empty()) throw std::invalid_argument("lists no codes");
    record.result.left_out = document.at("left_out").get<std::vector<std::string>>();
    return 0;
  });
  return record;
}

}  // namespace tofsmith
