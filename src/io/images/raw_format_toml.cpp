// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "io/shared/read_file.hpp"
#include "io/text/field_reader.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/raw_format.hpp"

namespace tofsmith {

namespace {

/// For a wrong key ending in "_bytes", lists all such keys, because the most similar one is often
/// wrong.
void refuse_unknown_gaps(const TomlDocument& document, RawFormat format) {
  KeyNames known;
  describe(known, format);
  std::erase_if(known.names, [](const std::string& name) { return !name.ends_with("_bytes"); });
  for (const auto& [key, node] : document.root())
    if (key.str().ends_with("_bytes") &&
        std::ranges::find(known.names, key.str()) == known.names.end())
      throw IoError(document.place_of(key.source()),
                    fmt::format("unknown key {}; expected one of {}", key.str(),
                                fmt::join(known.names, ", ")));
}

}  // namespace

RawFormat parse_raw_format(std::string_view text, std::string_view source_name) {
  const TomlDocument document(text, source_name);
  TableReader::Places places;
  TableReader table(document, places);
  FieldReader reader(table);
  RawFormat format;
  describe(reader, format);
  refuse_unknown_gaps(document, format);
  table.finish();
  try {
    format.validate();
  } catch (const InvalidArgument& error) {
    const std::string key = error.field().substr(0, error.field().find('['));
    const auto place = places.find(key);
    throw IoError(place == places.end() ? document.source_name() : place->second, error.what());
  }
  return format;
}

RawFormat read_raw_format(const std::filesystem::path& path) {
  return parse_raw_format(read_text_file(path, max_settings_file_bytes), path.string());
}

}  // namespace tofsmith
