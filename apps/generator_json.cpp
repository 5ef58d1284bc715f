// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "generator_json.hpp"

#include <nlohmann/json.hpp>

namespace tofsmith::apps {

nlohmann::ordered_json generators_json(const std::vector<GeneratorReport>& reports) {
  nlohmann::ordered_json document = nlohmann::ordered_json::array();
  for (const GeneratorReport& r : reports) {
    document.push_back({{"arm", r.arm == Arm::light ? "light" : "sensor"},
                        {"index", r.index},
                        {"points_per_period", r.points_per_period},
                        {"clock_hz", r.clock_hz},
                        {"duty_nominal", r.duty_nominal},
                        {"duty_actual", r.duty_actual},
                        {"mean_nominal", r.mean_nominal},
                        {"mean_actual", r.mean_actual},
                        {"peak_nominal", r.peak_nominal},
                        {"peak_actual", r.peak_actual},
                        {"edges_nominal", r.edges_nominal},
                        {"edges_actual", r.edges_actual},
                        {"rms_difference", r.rms_difference}});
    if (r.largest_edge_move_s) document.back()["largest_edge_move_s"] = *r.largest_edge_move_s;
  }
  return document;
}

}  // namespace tofsmith::apps
