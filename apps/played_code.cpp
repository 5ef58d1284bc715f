// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "played_code.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/measured_table_file.hpp"

namespace tofsmith::apps {

bool names_measured_table(const std::string& code) {
  std::error_code ignored;
  return !is_family(code) && std::filesystem::is_regular_file(code, ignored) &&
         is_measured_table(code);
}

void require_no_measured_table(const std::string& code) {
  if (names_measured_table(code))
    throw IoError(code,
                  "this is a measured table (corrfs only), and only decode takes those; expected "
                  "one of .json, .npz with modfs and demodfs");
}

CodeSet load_played_code(const std::string& code, const Camera& camera, const TapArguments& taps) {
  require_no_measured_table(code);
  CodeSet played = load_code(code, camera, taps.file_options());
  if (played.samples() != camera.samples)
    throw IoError(code, fmt::format("found {} samples per period; expected {} as of the camera "
                                    "(--set samples={} makes it fit)",
                                    played.samples(), camera.samples, played.samples()));
  return played;
}

}  // namespace tofsmith::apps
