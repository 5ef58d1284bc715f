// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tofsmith/io/npy.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith {

/// What became of one figure, table or statement of the paper: what to read, what to look at, and
/// the numbers behind both.
/// @see Gutierrez-Barragan et al., "Practical Coding Function Design for Time-of-Flight Imaging",
///      CVPR 2019 ("the paper")
struct Reproduction {
  std::vector<CheckedStatement> findings;  ///< the paper's statements beside our numbers
  std::vector<Section> sections;           ///< figures and tables, with the settings they hold for
  NpzArrays arrays;                        ///< written as data.npz; may be empty
  std::map<std::string, std::string> files;  ///< further files by name, such as "errors.csv"
};

/// holds or fails if all findings do, else in_part; holds when there are none.
Verdict overall_verdict(const std::vector<CheckedStatement>& findings);

}  // namespace tofsmith
