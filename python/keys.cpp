// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
//
// Prints the descriptions of a camera's keys, of all options structs and of decoded planes, from
// which make_camera_fields.py, make_option_fields.py and make_decoded_planes.py make Python
// classes.
#include <cstdio>

#include "field_list.hpp"
#include "tofsmith/calibrate/impulse_response.hpp"
#include "tofsmith/calibrate/photon_transfer.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/simulate/multipath_error.hpp"
#include "tofsmith/simulate/robustness.hpp"
#include "tofsmith/waveforms/upload_script.hpp"

int main() {
  using namespace tofsmith;
  const nlohmann::ordered_json options = {
      {"CaptureOptions", fields_list<CaptureOptions>()},
      {"DecodeOptions", fields_list<DecodeOptions>()},
      {"DecodeRequest", fields_list<DecodeRequest>()},
      {"DesignOptions", fields_list<DesignOptions>()},
      {"EvaluateOptions", fields_list<EvaluateOptions>()},
      {"ExportOptions", fields_list<ExportOptions>()},
      {"FilterOptions", fields_list<FilterOptions>()},
      {"MultipathErrorOptions", fields_list<MultipathErrorOptions>()},
      {"PhotonTransferOptions", fields_list<PhotonTransferOptions>()},
      {"RequirementOptions", fields_list<RequirementOptions>()},
      {"ResponseCalibrationOptions", fields_list<ResponseCalibrationOptions>()},
      {"ResponseRecordOptions", fields_list<ResponseRecordOptions>()},
      {"RobustnessOptions", fields_list<RobustnessOptions>()},
      {"SceneSource", fields_list<SceneSource>()},
      {"TimeFilterOptions", fields_list<TimeFilterOptions>()},
      {"UploadRequest", fields_list<UploadRequest>()},
      {"UploadSelection", fields_list<UploadSelection>()},
  };
  nlohmann::ordered_json planes = nlohmann::ordered_json::array();
  for (const PlaneDescription& described : plane_descriptions)
    planes.push_back({{"word", described.word},
                      {"member", described.member},
                      {"type", name_of(type_of(described.plane))},
                      {"unit", described.unit},
                      {"is_usual", described.use == PlaneUse::usual},
                      {"is_multipath", described.use == PlaneUse::of_returns},
                      {"help", help_of(described.plane)}});
  nlohmann::ordered_json synonyms;
  for (const PlaneSynonym& synonym : plane_synonyms)
    synonyms[synonym.name] = description_of(synonym.plane).member;
  const nlohmann::ordered_json all = {
      {"camera", nlohmann::ordered_json::parse(camera_keys_json())},
      {"options", options},
      {"planes", planes},
      {"statuses",
       {{"PixelStatus", words_of(PixelStatus())}, {"ReturnStatus", words_of(ReturnStatus())}}},
      {"plane_synonyms", synonyms}};
  return std::puts(all.dump().c_str()) < 0 ? 1 : 0;
}
