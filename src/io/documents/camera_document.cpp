// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/documents/camera_document.hpp"

#include "io/documents/camera_fields.hpp"
#include "io/documents/shared/document_text.hpp"
#include "io/text/table_writer.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {

/// The file a response came from, or else its samples.
void visit_measured_response(TableWriter& table, const ImpulseResponse& response) {
  if (response.file.empty())
    table.value("samples", response.samples);
  else
    table.value("file", response.file);
  table.value("time_step_s", response.time_step_s);
}

nlohmann::ordered_json camera_document(const Camera& camera) {
  camera.validate();
  TableWriter writer;
  camera_fields::visit_camera(writer, camera);
  return writer.document();
}

std::string camera_to_json(const Camera& camera) {
  return format_json(camera_document(camera)) + "\n";
}

std::string camera_to_toml(const Camera& camera) { return format_toml(camera_document(camera)); }

void write_camera_toml(const std::filesystem::path& path, Camera camera, OutputPolicy policy) {
  camera.name = path.stem().string();
  write_file_atomically(path, camera_to_toml(camera), policy);
}

}  // namespace tofsmith
