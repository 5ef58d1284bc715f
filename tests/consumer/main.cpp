// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <tofsmith/core/periodic.hpp>
#include <tofsmith/core/units.hpp>
#include <tofsmith/version.hpp>

// Where a pulse that left at bin 0 correlates best after a delay of 3 bins.
int main() {
  const Eigen::VectorXd sent = Eigen::VectorXd::Unit(8, 0);
  const Eigen::VectorXd received = tofsmith::circular_shift(sent, 3);
  Eigen::Index delay_bin = 0;
  tofsmith::circular_correlation(received, sent).maxCoeff(&delay_bin);
  std::cout << "tofsmith " << TOFSMITH_VERSION << ": delay " << delay_bin << " of 8, "
            << tofsmith::unambiguous_range_m(15e6) << " m range\n";
  return delay_bin == 3 ? 0 : 1;
}
