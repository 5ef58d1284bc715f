// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulate/row_capture.hpp"
#include "tofsmith/core/progress.hpp"

namespace tofsmith {

/// All rows of all frames, on all threads.
RawFrames captured_rows(const RowCapture& source, int height, int width, int frames,
                        const Progress& progress);

}  // namespace tofsmith
