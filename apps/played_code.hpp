// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tap_arguments.hpp"

namespace tofsmith::apps {

/// Whether a code's argument names a file that holds correlation functions only.
bool names_measured_table(const std::string& code);

/// What decode alone takes. @throws IoError if names_measured_table(code)
void require_no_measured_table(const std::string& code);

/// The code that the camera plays, of its number of samples.
/// @throws IoError as load_code(), or for a measured table
CodeSet load_played_code(const std::string& code, const Camera& camera, const TapArguments& taps);

}  // namespace tofsmith::apps
