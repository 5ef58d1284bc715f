// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/design_directory.hpp"
#include "tofsmith/io/result_document.hpp"

namespace tofsmith {

void write_requirements(const std::filesystem::path& directory, const Camera& camera,
                        const Requirements& found, const RequirementOptions& options,
                        OutputPolicy policy) {
  make_output_directory(directory);
  write_code(directory / "as_it_is.code.json", found.code, policy);
  for (const Sufficiency& s : found.varied) {
    if (!s.factor) continue;
    const std::string name(name_of(s.quantity));
    write_code(directory / (name + ".code.json"), s.code, policy);
    write_file_atomically(directory / (name + ".camera.toml"),
                          camera_to_toml(with_scaled(camera, s.quantity, *s.factor)), policy);
  }
  write_file_atomically(directory / "requirements.json",
                        requirements_document(camera, found, options) + "\n", policy);
}

}  // namespace tofsmith
