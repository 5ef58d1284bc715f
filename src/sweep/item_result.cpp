// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/item_result.hpp"

#include "io/documents/shared/document_text.hpp"
#include "io/documents/shared/result_json.hpp"
#include "tofsmith/io/code_file.hpp"

namespace tofsmith {

std::string item_result_json(const DepthErrorReport& report, const CodeSet* designed) {
  nlohmann::ordered_json entry = {{"trials", report.trials},
                                  {"seed", report.seed},
                                  {"outlier_threshold_m", report.outlier_threshold_m}};
  entry.update(depth_error_json(report, 0));
  entry.erase("name");
  entry.erase("rotation_bin");
  if (designed) entry["designed"] = nlohmann::ordered_json::parse(code_to_json(*designed));
  return entry.dump();
}

ItemResult parse_item_result(const std::string& json, const std::string& code,
                             std::string_view file) {
  nlohmann::json entry = parse_json(json, file);
  if (!entry.is_object()) JsonReader(entry, file).mistyped("the result of an item");
  entry["name"] = code;
  const JsonReader reader(entry, file);
  ItemResult result{depth_error_from_json(reader, reader), {}};
  if (entry.contains("designed"))
    result.designed = parse_code_json(entry["designed"].dump(), file).renamed(code);
  return result;
}

}  // namespace tofsmith
