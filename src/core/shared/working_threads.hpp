// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith {

/// Returns the maximum number of threads of parallel_for: all cores, or the current ThreadLimit.
int working_threads();

}  // namespace tofsmith
