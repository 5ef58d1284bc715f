// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The web page (apps/lab) has no file system. These functions report that and replace the file
// readers, which are not compiled for it.
#ifdef __EMSCRIPTEN__

#include <string>

#include "io/arrays/shared/array_matrix.hpp"
#include "io/documents/shared/lens_document.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/measured_table_file.hpp"

namespace tofsmith {

namespace {

[[noreturn]] void refuse_file(const std::string& file, const char* expected) {
  throw IoError(file, std::string("the page cannot read other files; expected ") + expected);
}

}  // namespace

ImpulseResponse read_impulse_response(const std::filesystem::path& path,
                                      std::optional<double> /*time_step_s*/) {
  refuse_file(path.string(), "samples = [...] with time_step_s instead");
}

Lens read_lens_calibration(const std::filesystem::path& path,
                           std::optional<DistortionModel> /*model*/, std::string_view /*camera*/) {
  refuse_file(path.string(), "fx_px, fy_px, cx_px and cy_px instead");
}

CodeSet parse_code_npz(std::span<const std::byte> /*content*/, std::string_view file,
                       const TapLayout& /*layout*/) {
  refuse_file(std::string(file), "the text of a .json file");
}

CodeSet parse_code_csv(std::string_view /*text*/, std::string_view file, bool /*is_signed*/) {
  refuse_file(std::string(file), "the text of a .json file");
}

CodeSet read_code_arrays(const std::filesystem::path& light, const std::filesystem::path& /*gates*/,
                         const TapLayout& /*layout*/) {
  refuse_file(light.string(), "the text of a .json file");
}

CodeSet read_rows(const std::filesystem::path& path) {
  refuse_file(path.string(), "the text of a .json file");
}

CodeSet read_rows(const std::filesystem::path& light, const std::filesystem::path& /*rows*/) {
  refuse_file(light.string(), "the text of a .json file");
}

std::vector<std::byte> serialize_code_npz(const CodeSet& /*code*/,
                                          std::optional<TapOrder> /*order*/) {
  refuse_file("code.npz", "the text of a .json file");
}

}  // namespace tofsmith

#endif
