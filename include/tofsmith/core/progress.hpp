// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

namespace tofsmith {

/// How far long work has come. Called now and then, from the thread that started the work.
/// @param fraction  share of the work that is done, in [0, 1]
/// @param step      what is being done, in a few words
/// @return false to stop: the work then throws Interrupted
using Progress = std::function<bool(double fraction, std::string_view step)>;

/// Reports to `progress` if there is one.
/// @throws Interrupted if the callback asks to stop
void report(const Progress& progress, double fraction, std::string_view step);

/// The part [begin, end] of `whole`, seen as a progress of its own.
Progress part_of(const Progress& whole, double begin, double end);

}  // namespace tofsmith
