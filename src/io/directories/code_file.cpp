// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/code_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/shared/text_numbers.hpp"
#include "io/arrays/shared/array_matrix.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

std::string near_family(const std::string& name) {
  std::vector<std::string> known;
  for (const FamilyDescription& family : list_families()) known.push_back(family.example);
  std::string in_lower_case = name;
  std::transform(name.begin(), name.end(), in_lower_case.begin(), lower_case);
  const auto begins_with_name = [&](const std::string& family) {
    return family.starts_with(in_lower_case + "-");
  };
  const auto named = std::find_if(known.begin(), known.end(), begins_with_name);
  std::string near = named != known.end() ? *named : nearest_word(in_lower_case, known);
  if (near.empty()) return "; `tofsmith codes` lists them";
  // Keep the user's number; only the word before it is wrong.
  const auto without_number = [](const std::string& word) {
    return word.substr(0, word.find_last_not_of("0123456789") + 1);
  };
  const std::string number = name.substr(without_number(name).size());
  if (!number.empty() && is_family(without_number(near) + number))
    near = without_number(near) + number;
  return fmt::format("; did you mean {}?", near);
}

}  // namespace

CodeSet read_code(const std::filesystem::path& path, const TapLayout& layout) {
  const std::string extension = known_extension(path, {".json", ".npz", ".csv"});
  if (extension == ".json") return parse_code_json(read_text_file(path), path.string());
  if (extension == ".csv")
    return parse_code_csv(read_text_file(path), path.string(), layout.is_signed);
  return parse_code_npz(read_binary_file(path), path.string(), layout);
}

void write_code(const std::filesystem::path& path, const CodeSet& code, OutputPolicy policy,
                std::optional<TapOrder> order) {
  if (known_extension(path, {".json", ".npz"}) == ".json")
    write_file_atomically(path, code_to_json(code), policy);
  else
    write_file_atomically(path, serialize_code_npz(code, order), policy);
}

std::vector<AtlasEntry> read_atlas(const std::filesystem::path& path) {
  return parse_atlas(read_text_file(path), path.string());
}

CodeSet load_code(const std::string& name_or_path, const Camera& camera,
                  const CodeFileOptions& options) {
  if (name_or_path.empty())
    throw IoError("code", "found an empty name; expected a built-in family or a file");
  if (is_family(name_or_path)) return build_family(name_or_path, camera);
  if (const AtlasEntry* entry = find_atlas_entry(name_or_path))
    return entry->code.resampled(camera.samples);
  const TapLayout layout{options.taps.value_or(camera.sensor.taps), options.tap_order,
                         camera.sensor.is_signed()};
  const bool reads_rows = camera.sensor.readout == Readout::rows;
  constexpr std::string_view between = ".npy,";
  if (const std::size_t at = name_or_path.find(between); at != std::string::npos) {
    const std::string light = name_or_path.substr(0, at + between.size() - 1);
    const std::string gates = name_or_path.substr(at + between.size());
    return reads_rows ? read_rows(light, gates) : read_code_arrays(light, gates, layout);
  }
  std::error_code ignored;
  if (!std::filesystem::exists(name_or_path, ignored))
    throw IoError(name_or_path, fmt::format("there is no such file and no built-in family of that "
                                            "name{}",
                                            near_family(name_or_path)));
  if (lower_extension(name_or_path) == ".toml")
    throw IoError(name_or_path,
                  "found a camera or another TOML file; expected a code: a family, .json, .npz or "
                  ".csv (--camera selects a camera)");
  if (reads_rows && lower_extension(name_or_path) == ".npz") return read_rows(name_or_path);
  return read_code(name_or_path, layout);
}

}  // namespace tofsmith
