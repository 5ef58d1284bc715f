// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// All of tofsmith::design: codes for a camera. Includes tofsmith/core.hpp.

#include "tofsmith/core.hpp"
#include "tofsmith/design/candidate.hpp"
#include "tofsmith/design/chip_search.hpp"
#include "tofsmith/design/circulant_tv.hpp"
#include "tofsmith/design/code_gradients.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/design/factorize.hpp"
#include "tofsmith/design/optimize.hpp"
