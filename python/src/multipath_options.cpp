// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "multipath_options.hpp"

#include "options.hpp"

namespace tofsmith::python {

MultipathOptions multipath_options(const py::dict& values, const std::string& owner,
                                   double range_m) {
  MultipathOptions options;
  OptionReader reader(values, owner);
  reader.value("threshold", options.threshold)
      .value("shortest_delay_m", options.shortest_delay_m)
      .value("longest_delay_m", options.longest_delay_m)
      .value("tail_m", options.tail_m);
  const py::dict prior = reader.table("prior");
  if (!prior.empty()) {
    options.prior.emplace();
    OptionReader prior_reader(prior, owner + ".prior");
    prior_reader.value("single_probability", options.prior->single_probability)
        .value("mean_delay_m", options.prior->mean_delay_m)
        .value("largest_ratio", options.prior->largest_ratio)
        .finish();
  }
  reader.finish();
  options.validate(range_m);
  return options;
}

}  // namespace tofsmith::python
