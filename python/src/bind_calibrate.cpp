// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "field_dicts.hpp"
#include "options.hpp"
#include "reports.hpp"
#include "tofsmith/calibrate/calibration_camera.hpp"
#include "tofsmith/calibrate/calibration_reports.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith::python {

namespace {

py::dict record_dict(ResponseRecord record) {
  py::dict dict;
  dict["values"] = adopt(std::move(record.values));
  dict["time_step_s"] = record.time_step_s;
  dict["start_time_s"] = record.start_time_s;
  dict["counts"] = record.counts;
  dict["notes"] = record.notes;
  return dict;
}

py::dict read_record(const std::string& path, const py::dict& values) {
  ResponseRecordOptions options;
  read_options(values, "", options);
  return record_dict(read_response_record(path, options));
}

py::dict response_dict(const CalibratedResponse& found) {
  py::list peaks;
  for (const ResponsePeak& peak : found.peaks)
    peaks.append(py::make_tuple(peak.time_s, peak.height));
  py::dict dict;
  dict["excitation"] = std::string(name_of(found.excitation));
  dict["falling"] = found.falling;
  dict["background"] = found.background;
  dict["height"] = found.height;
  dict["noise_rms"] = found.noise_rms;
  dict["snr_db"] = found.snr_db;
  dict["delay_s"] = found.delay_s;
  dict["response"] = impulse_response_dict(found.response);
  dict["response_centre_s"] = found.response_centre_s;
  dict["bandwidth_hz"] = pair_of(found.bandwidth_hz);
  dict["fits"] = object_of(found.fits);
  dict["fit_is_good"] = found.fit_is_good();
  dict["peaks"] = peaks;
  dict["record"] = record_dict(found.record);
  dict["notes"] = found.notes;
  return dict;
}

CalibratedResponse calibrate_response(const Doubles& values, double time_step_s,
                                      double start_time_s, bool counts,
                                      const std::vector<std::string>& notes, const Camera& camera,
                                      const py::dict& given) {
  ResponseRecord record{.values = to_vector(values),
                        .time_step_s = time_step_s,
                        .start_time_s = start_time_s,
                        .counts = counts,
                        .notes = notes};
  ResponseCalibrationOptions options{.fundamental_frequency_hz = camera.fundamental_frequency_hz,
                                     .samples = camera.samples};
  read_options(given, "", options);
  const py::gil_scoped_release release;
  return calibrate_impulse_response(std::move(record), options);
}

Camera responding(const CalibratedResponse& found, const Camera& camera, const std::string& arm,
                  const std::string& kind) {
  return with_response(camera, response_of(found, parse_response_kind(kind)),
                       parse_response_arm(arm));
}

void write_responding(const CalibratedResponse& found, const std::string& path,
                      const Camera& camera, const std::string& arm, const std::string& kind,
                      bool overwrite) {
  const ResponseArm whose = parse_response_arm(arm);
  const ImpulseResponse response = write_response_beside(
      path, response_of(found, parse_response_kind(kind)), policy_of(overwrite));
  write_file_atomically(path, calibrated_camera_toml(with_response(camera, response, whose)),
                        policy_of(overwrite));
}

PhotonTransfer measure_noise(const py::list& levels, const py::object& dark, const Camera& camera,
                             const std::optional<CodeSet>& code, const py::dict& values) {
  std::vector<RawFrames> frames;
  for (const py::handle level : levels)
    frames.push_back(to_raw_frames(py::reinterpret_borrow<py::object>(level), "levels"));
  const RawFrames dark_frames = to_raw_frames(dark, "dark");
  PhotonTransferOptions options = noise_options(camera, !dark.is_none());
  read_options(values, "", options);
  const py::gil_scoped_release release;
  if (!code) return photon_transfer(frames, dark_frames, options);
  return photon_transfer(frames, dark_frames,
                         make_decoding_table(ForwardModel(*code, camera), camera), options);
}

}  // namespace

void bind_calibrate(py::module_& module) {
  module.def("read_response_record", &read_record);
  py::class_<CalibratedResponse>(module, "CalibratedResponse")
      .def("fields", &response_dict)
      .def("camera", &responding)
      .def("write_camera", &write_responding)
      .def("write_report", writing(&response_report));
  module.def("calibrate_impulse_response", &calibrate_response);
  py::class_<PhotonTransfer>(module, "PhotonTransfer")
      .def("fields", &fields_dict<PhotonTransfer>)
      .def("camera", [](const PhotonTransfer& found,
                        const Camera& camera) { return with_noise(camera, found); })
      .def("write_report",
           [](const PhotonTransfer& found, const std::string& path, bool overwrite) {
             write_page(path, noise_report(found, ""), overwrite);
           });
  module.def("photon_transfer", &measure_noise);
}

}  // namespace tofsmith::python
