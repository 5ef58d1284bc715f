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

/// A code's entry of evaluation and design documents.
nlohmann::ordered_json depth_error_json(const DepthErrorReport& report, int rotation_bin);

/// The same back from a document; standard errors of outlier rates are not in it.
/// @throws IoError naming file and member
DepthErrorReport depth_error_from_json(const JsonReader& entry, const JsonReader& document);

/// A code's depth error on perturbed cameras, each beside its ratio to the nominal one.
nlohmann::ordered_json robustness_json(const RobustnessReport& report);

/// @throws IoError where the text is no kind's name
DepthErrorKind parse_word(const JsonReader& json, DepthErrorKind);

/// What generators make of each waveform.
nlohmann::ordered_json generators_json(const std::vector<GeneratorReport>& reports);
/// What that costs in depth error of a kind.
nlohmann::ordered_json generator_loss_json(const GeneratorLoss& loss, DepthErrorKind kind);

/// The measurements of a designed code and, where it has targets, how they compare with them.
nlohmann::ordered_json measurements_json(const Candidate& candidate);
/// The same back, without histories; none where the entry has no `per_measurement`.
std::vector<MeasurementReport> measurements_from_json(const JsonReader& entry);

/// Version, seed, trials, outlier threshold and camera: the head of every result document.
nlohmann::ordered_json document_head(const Camera& camera, std::uint64_t seed, std::int64_t trials,
                                     double outlier_threshold_m);

/// The head, the name of the best and one entry per candidate.
nlohmann::ordered_json design_json(const Camera& camera, const DesignResult& result,
                                   const DesignOptions& options);

}  // namespace tofsmith
