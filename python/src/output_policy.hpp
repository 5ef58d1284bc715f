// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith::python {

inline OutputPolicy policy_of(bool overwrite) {
  return overwrite ? OutputPolicy::overwrite : OutputPolicy::refuse_existing;
}

}  // namespace tofsmith::python
