// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "io/text/json_reader.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith {

/// Returns a code's entry in evaluation and design documents.
nlohmann::ordered_json depth_error_json(const DepthErrorReport& report, int rotation_bin);

/// Reads such an entry, which does not contain standard errors of outlier rates.
/// @throws IoError naming file and member
DepthErrorReport depth_error_from_json(const JsonReader& entry, const JsonReader& document);

/// Returns a code's depth errors on perturbed cameras and their ratios to the nominal error.
nlohmann::ordered_json robustness_json(const RobustnessReport& report);

/// @throws IoError if the text is not the name of a kind
DepthErrorKind parse_word(const JsonReader& json, DepthErrorKind);

/// Returns the generator limits and errors of each waveform.
nlohmann::ordered_json generators_json(const std::vector<GeneratorReport>& reports);
/// Returns the loss of depth error of a kind due to generators.
nlohmann::ordered_json generator_loss_json(const GeneratorLoss& loss, DepthErrorKind kind);

/// Returns the measurements of a designed code and their comparison with targets, if any.
nlohmann::ordered_json measurements_json(const Candidate& candidate);
/// Reads such measurements without histories; none if the entry has no `per_measurement`.
std::vector<MeasurementReport> measurements_from_json(const JsonReader& entry);

/// Returns the head of every result document: version, seed, trials, outlier threshold and camera.
nlohmann::ordered_json document_head(const Camera& camera, std::uint64_t seed, std::int64_t trials,
                                     double outlier_threshold_m);

/// Returns the head, the name of the best code and one entry per candidate.
nlohmann::ordered_json design_json(const Camera& camera, const DesignResult& result,
                                   const DesignOptions& options);

}  // namespace tofsmith
