// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "multipath_options.hpp"

#include "options.hpp"

namespace tofsmith::python {

MultipathOptions multipath_options(const py::dict& values, const std::string& owner,
                                   double range_m) {
  MultipathOptions options;
  OptionReader(values, owner).fields(options, {"status_thresholds"}).finish();
  options.validate(range_m);
  return options;
}

}  // namespace tofsmith::python
