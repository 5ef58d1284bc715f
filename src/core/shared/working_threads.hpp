// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith {

/// Maximum number of threads: all cores, or the current ThreadLimit.
int working_threads();

}  // namespace tofsmith
