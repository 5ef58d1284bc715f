// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith {

/// How many threads parallel_for works on at most: all cores, or what ThreadLimit says.
int working_threads();

}  // namespace tofsmith
