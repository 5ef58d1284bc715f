// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/item_result.hpp"

#include "io/documents/shared/document_text.hpp"
#include "io/documents/shared/result_json.hpp"

namespace tofsmith {

std::string item_result_json(const DepthErrorReport& report) {
  nlohmann::ordered_json entry = {{"trials", report.trials},
                                  {"seed", report.seed},
                                  {"outlier_threshold_m", report.outlier_threshold_m}};
  entry.update(depth_error_json(report, 0));
  entry.erase("name");
  entry.erase("rotation_bin");
  return entry.dump();
}

DepthErrorReport parse_item_result(const std::string& json, const std::string& code,
                                   std::string_view file) {
  nlohmann::json entry = parse_json(json, file);
  entry["name"] = code;
  const JsonReader reader(entry, file);
  return depth_error_from_json(reader, reader);
}

}  // namespace tofsmith
