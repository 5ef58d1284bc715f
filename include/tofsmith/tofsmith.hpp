// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// All components that are installed.

#include "tofsmith/core.hpp"
#if __has_include("tofsmith/design.hpp")
#include "tofsmith/design.hpp"
#endif
#if __has_include("tofsmith/gpu.hpp")
#include "tofsmith/gpu.hpp"
#endif
#if __has_include("tofsmith/io.hpp")
#include "tofsmith/io.hpp"
#endif
#if __has_include("tofsmith/lab.hpp")
#include "tofsmith/lab.hpp"
#endif
#if __has_include("tofsmith/report.hpp")
#include "tofsmith/report.hpp"
#endif
#if __has_include("tofsmith/sweep.hpp")
#include "tofsmith/sweep.hpp"
#endif
