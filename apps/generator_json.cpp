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
                        {"duty_told", r.duty_told},
                        {"duty_played", r.duty_played},
                        {"mean_told", r.mean_told},
                        {"mean_played", r.mean_played},
                        {"peak_told", r.peak_told},
                        {"peak_played", r.peak_played},
                        {"edges_told", r.edges_told},
                        {"edges_played", r.edges_played},
                        {"rms_difference", r.rms_difference}});
    if (r.largest_edge_move_s) document.back()["largest_edge_move_s"] = *r.largest_edge_move_s;
  }
  return document;
}

}  // namespace tofsmith::apps
