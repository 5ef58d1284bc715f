// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "tofsmith/decode/multipath_decoder.hpp"

namespace tofsmith::python {

/// Reads the options of two-return and tail decoding from a dict; `owner` is its name in errors.
/// @throws std::invalid_argument naming the violated rule or an unknown name
MultipathOptions multipath_options(const pybind11::dict& values, const std::string& owner,
                                   double range_m);

}  // namespace tofsmith::python
