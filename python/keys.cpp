// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
//
// Prints the descriptions of a camera's keys, of options, results and decoded planes, from which
// make_camera_fields.py, make_option_fields.py, make_result_fields.py and make_decoded_planes.py
// make Python classes.
#include <cstdio>

#include "field_list.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/calibrate/impulse_response.hpp"
#include "tofsmith/calibrate/photon_transfer.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/design/candidate.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/simulate/interference_error.hpp"
#include "tofsmith/simulate/motion_error.hpp"
#include "tofsmith/simulate/multipath_error.hpp"
#include "tofsmith/simulate/robustness.hpp"
#include "tofsmith/sweep/training_set.hpp"
#include "tofsmith/waveforms/upload_script.hpp"

namespace {

using namespace tofsmith;

/// Description of a Python class with the fields of a struct.
template <typename Result>
nlohmann::ordered_json result(const char* name, const char* help) {
  return {{"name", name}, {"help", help}, {"fields", result_fields<Result>()}};
}

/// Description of a Python class with one array per field.
template <typename Row>
nlohmann::ordered_json columns(const char* name, const char* help) {
  const nlohmann::ordered_json rows = {{"name", "rows"},
                                       {"type", "table[]"},
                                       {"as_object", false},
                                       {"fields", result_fields<Row>()}};
  return {{"name", name}, {"help", help}, {"fields", nlohmann::ordered_json::array({rows})}};
}

nlohmann::ordered_json results() {
  return {
      result<DepthErrorMean>("DepthErrorMean",
                             "Means of the depth error over all operating points"),
      result<DepthErrorReport>(
          "DepthErrorReport",
          "Depth error of a code on a camera. Arrays have one entry per operating point, (P,), "
          "ordered by signal"),
      result<RobustnessReport>(
          "RobustnessReport",
          "Depth error if the camera deviates from its description: geometric means over its "
          "operating points"),
      result<WrongShares>(
          "WrongShares",
          "Shares of trials with wrong depths. A depth is wrong if it deviates from all true "
          "depths by more than three times its `deviation_m`"),
      result<MotionErrors>("MotionErrors",
                           "Depth errors of trials whose exposures saw different depths"),
      result<MotionReport>("MotionReport",
                           "Effect of motion while the exposures of a frame follow one another"),
      result<InterferenceReport>(
          "InterferenceReport",
          "Effect of the light of other cameras, as in the camera's `operating.interference`"),
      columns<MultipathCell>("MultipathCells",
                             "Circular error of the direct depth; all arrays have the same shape"),
      result<GeneratorReport>("GeneratorReport",
                              "Nominal and actual properties of one waveform on its generator"),
      result<MeasurementReport>(
          "MeasurementReport",
          "One measurement of a designed code and its comparison with the target, if any. Arrays "
          "(iterations,) belong to the best random start"),
      result<SearchRecord>("SearchRecord", "Progress of a code search; arrays (steps,)"),
      result<PhotonTransferPoint>("PhotonTransferPoint",
                                  "One measurement in a pair of frames with the same light"),
      result<PhotonTransfer>(
          "PhotonTransfer",
          "Noise of a sensor: variance [DN^2] = read_noise^2 / gain^2 + (mean - black) / gain + "
          "1/12; for differences of two buckets 2 read_noise^2 / gain^2 + light / gain + 2/12"),
      result<DeadPixels>("DeadPixels", "Number of excluded pixels by reason, each counted once"),
      result<HarmonicRatio>("HarmonicRatio",
                            "Amplitudes of one harmonic of a measured table and of an ideal code"),
      result<IdealCodeFit>("IdealCodeFit", "An ideal code fitted to a measured table"),
      result<ParametricResponse>("ParametricResponse", "A parametric response fitted to a record"),
      result<TrainingSetRun>("TrainingSetRun", "Result of write_training_set()"),
      result<SensorDrift>(
          "SensorDrift",
          "Part of the drift that follows the temperature of the sensor; see TemperatureDrift"),
      result<TemperatureDrift>("TemperatureDrift", "Drift of depth and signal with temperature"),
      result<CalibratedStrayLight>("CalibratedStrayLight", "Result of calibrate_stray_light()"),
      result<ExposureOrder>("ExposureOrder",
                            "Order of exposures that a design chose for moving surfaces"),
  };
}

}  // namespace

int main() {
  const nlohmann::ordered_json options = {
      {"CaptureOptions", fields_list<CaptureOptions>()},
      {"CodeFileOptions", fields_list<CodeFileOptions>()},
      {"DecodeOptions", fields_list<DecodeOptions>()},
      {"DecodeRequest", fields_list<DecodeRequest>()},
      {"DecodingTableOptions", fields_list<DecodingTableOptions>()},
      {"DelaySweepOptions", fields_list<DelaySweepOptions>()},
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
      {"TrainingSetOptions", fields_list<TrainingSetOptions>()},
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
      {"results", results()},
      {"planes", planes},
      {"statuses",
       {{"PixelStatus", all_words<PixelStatus>}, {"ReturnStatus", all_words<ReturnStatus>}}},
      {"plane_synonyms", synonyms}};
  return std::puts(all.dump().c_str()) < 0 ? 1 : 0;
}
