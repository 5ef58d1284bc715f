// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/design/design.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith {

/// How many times as large as the winner's the error of every other candidate is.
Section gain_section(const Camera& camera, const DesignResult& result);

/// How the designed codes were found: errors against work, residuals against iterations, and what
/// exhaustive searches counted.
Section search_section(const DesignResult& result);

}  // namespace tofsmith
