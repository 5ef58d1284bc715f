// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// All of tofsmith::sweep: parameter sweeps and their stores. Includes tofsmith/io.hpp.

#include "tofsmith/io.hpp"
#include "tofsmith/sweep/run_sweep.hpp"
#include "tofsmith/sweep/training_set.hpp"
