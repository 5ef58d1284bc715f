// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/report/page.hpp"

namespace tofsmith {

/// A page with every kind of block and figure, filled with plausible invented values.
Page sample_page();

}  // namespace tofsmith
