// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "tofsmith/core/error.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {

void DesignOptions::validate() const {
  check_fields(*this, "DesignOptions::");
  for (const int e : exposures) {
    require(std::count(exposures.begin(), exposures.end(), e) == 1, "DesignOptions::exposures", e,
            "must be listed once");
    require(method != DesignMethod::factorize || (e >= 3 && e <= 6), "DesignOptions::exposures", e,
            "must be in [3, 6] for Hamiltonian targets");
  }
  if (baselines)
    for (const std::string& name : *baselines)
      require(std::count(baselines->begin(), baselines->end(), name) == 1,
              "DesignOptions::baselines", name, "must be listed once");
  require(!target || !target->measurements.empty(), "DesignOptions::target", "[]",
          "must contain at least one correlation function");
  factorize.validate();
  optimize.validate();
  search.validate();
}

DesignOptions with_effort(DesignOptions options, double effort) {
  require(effort == 0.0 || (effort >= 0.01 && effort <= 100.0), "effort", effort,
          "must be 0 or in [0.01, 100]");
  if (effort == 0.0) {
    require(options.method == DesignMethod::best || options.method == DesignMethod::atlas, "effort",
            effort, "must be > 0 for methods that only search");
    options.method = DesignMethod::atlas;
    return options;
  }
  scale_by_effort(options, effort);
  return options;
}

}  // namespace tofsmith
