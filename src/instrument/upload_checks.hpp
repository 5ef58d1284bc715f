// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/instrument/upload_script.hpp"

namespace tofsmith {

/// @throws std::invalid_argument naming what of a request does not fit the model
void check_upload(const GeneratorModel& model, const UploadRequest& request);

}  // namespace tofsmith
