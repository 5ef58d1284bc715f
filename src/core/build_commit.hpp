// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith {

/// Written at build time by cmake/build_commit.cmake.
extern const char* const build_commit;

}  // namespace tofsmith
