// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// All of tofsmith::report: figures and pages. Includes tofsmith/io.hpp.

#include "tofsmith/io.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/design_report.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/report/page.hpp"
