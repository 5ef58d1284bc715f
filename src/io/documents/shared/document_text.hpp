// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "io/text/field_json.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith {

/// @throws IoError "file:line:column: ..." at the first syntax error
Document parse_json(std::string_view text, std::string_view file);

/// Formats one member per line; lists of plain values, and elements of lists, are on one line.
/// Numbers are read back exactly.
/// @throws std::invalid_argument if a text is not UTF-8
std::string format_json(const nlohmann::ordered_json& document);

/// Formats plain values first, then one section per table; nested tables are in braces.
/// @throws std::invalid_argument if a text is not UTF-8
std::string format_toml(const nlohmann::ordered_json& document);

/// Fills in defaults. @throws std::invalid_argument if the camera is invalid
nlohmann::ordered_json camera_document(const Camera& camera);

/// @throws IoError as parse_code_json()
CodeSet code_from_json(const ValueReader& json);

nlohmann::ordered_json depth_error_json(const DepthErrorReport& report, int rotation_bin);

/// Entries do not contain standard errors of outlier rates.
/// @throws IoError naming file and member
DepthErrorReport depth_error_from_json(const ValueReader& entry, const ValueReader& document);

nlohmann::ordered_json generators_json(const std::vector<GeneratorReport>& reports);
nlohmann::ordered_json generator_loss_json(const GeneratorLoss& loss, DepthErrorKind kind);

nlohmann::ordered_json measurements_json(const Candidate& candidate);
/// Omits histories; none if the entry has no `per_measurement`.
std::vector<MeasurementReport> measurements_from_json(const ValueReader& entry);

}  // namespace tofsmith
