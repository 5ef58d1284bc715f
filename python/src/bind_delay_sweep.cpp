// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "field_dicts.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "reports.hpp"
#include "tofsmith/calibrate/calibration_camera.hpp"
#include "tofsmith/calibrate/calibration_reports.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/image_file.hpp"

namespace tofsmith::python {

namespace {

py::dict read_sweep(const std::string& path, const Camera& camera, const py::dict& values) {
  DelaySweepOptions options;
  read_options(values, "", options);
  DelaySweep sweep = read_delay_sweep(path, camera, options);
  py::dict dict;
  dict["delay_periods"] = adopt(std::move(sweep.delay_periods));
  dict["frames"] = adopt(std::move(sweep.frames));
  dict["notes"] = sweep.notes;
  return dict;
}

CorrelationCalibrationOptions calibration_options(const DelaySweep& sweep, const Camera& camera,
                                                  const py::object& dark,
                                                  const py::object& geometry_m,
                                                  const py::dict& values) {
  CorrelationCalibrationOptions options = sweep_options(camera, sweep);
  options.dark = to_raw_frames(dark, "dark");
  options.geometry_m = to_image(geometry_m, "geometry_m");
  std::optional<double> target_distance_m;
  OptionReader(values, "")
      .value("black_level", options.black_level)
      .value("saturation_level", options.saturation_level)
      .value("target_distance_m", target_distance_m)
      .finish();
  if (target_distance_m)
    options.geometry_m =
        flat_target_geometry_m(*target_distance_m, camera, sweep.frames.height, sweep.frames.width);
  return options;
}

CalibratedCorrelation calibrate(const Doubles& delay_periods, const py::object& frames,
                                const std::vector<std::string>& notes, const Camera& camera,
                                const py::object& dark, const py::object& geometry_m,
                                const py::dict& values, const py::object& callback) {
  DelaySweep sweep{.frames = to_raw_frames(frames, "sweep.frames"), .notes = notes};
  sweep.delay_periods.assign(delay_periods.data(), delay_periods.data() + delay_periods.size());
  const CorrelationCalibrationOptions options =
      calibration_options(sweep, camera, dark, geometry_m, values);
  return without_gil(callback, [&](const Progress& progress) {
    return calibrate_correlation(sweep, options, progress);
  });
}

py::dict correlation_dict(const CalibratedCorrelation& found) {
  const auto or_none = [](bool known, const Estimate& estimate) {
    return known ? py::object(pair_of(estimate)) : py::object(py::none());
  };
  py::dict dict;
  dict["correlation"] = adopt(Eigen::MatrixXd(found.table.correlation));
  dict["standard_error"] = adopt(Eigen::MatrixXd(found.standard_error));
  dict["ambient_gain"] = adopt(Eigen::VectorXd(found.table.ambient_gain));
  dict["model_error_percent"] = found.table.model_error_percent;
  dict["exposure_s"] = adopt(Eigen::VectorXd(found.table.exposure_s));
  dict["black_level"] = adopt(Eigen::VectorXd(found.table.black_level));
  dict["taps"] = found.table.taps;
  dict["delay_offset_m"] = adopt(Image<float>(found.maps.delay_offset_m));
  dict["gain"] = adopt(Image<float>(found.maps.gain));
  dict["delay_error_m"] = found.delay_error_m;
  dict["gain_error"] = found.gain_error;
  dict["dead"] = fields_dict(found.dead);
  dict["drift_corrected"] = found.drift_corrected;
  dict["light_drift"] = or_none(found.drift_known, found.light_drift);
  dict["level_drift"] = or_none(found.drift_known, found.level_drift);
  dict["tap_mismatch"] = object_of(found.tap_mismatch);
  dict["noise_rms"] = found.noise_rms;
  dict["noise_source"] = found.noise_source;
  dict["notes"] = found.notes;
  return dict;
}

std::vector<IdealCodeFit> fits_of(const CalibratedCorrelation& found, const Camera& camera,
                                  const std::optional<std::vector<CodeSet>>& codes) {
  const py::gil_scoped_release release;
  return fit_ideal_codes(found.table.correlation, found.standard_error, camera,
                         codes ? *codes : ideal_codes(camera, found.table.columns()));
}

ReferenceDepth reference_of(const py::list& images) {
  ReferenceDepth reference;
  for (const py::handle& image : images)
    reference.depth_m.push_back(to_image(py::reinterpret_borrow<py::object>(image), "reference"));
  return reference;
}

py::list read_reference(const std::string& path) {
  py::list images;
  for (Image<float>& image : read_reference_depth(path).depth_m)
    images.append(adopt(std::move(image)));
  return images;
}

CalibratedDepth calibrate_by_reference(const py::object& frames, const py::list& images, bool is_z,
                                       const CodeSet& code, const Camera& camera,
                                       const py::object& callback) {
  const RawFrames raw = to_raw_frames(frames, "frames");
  ReferenceDepth reference = reference_of(images);
  reference.is_z = is_z;
  return without_gil(callback, [&](const Progress& progress) {
    return calibrate_depth(raw, reference, code, camera, progress);
  });
}

py::dict depth_dict(const CalibratedDepth& found) {
  py::list terms;
  for (const CalibratedTerm& term : found.terms)
    terms.append(py::make_tuple(term.name, pair_of(term.value_m)));
  py::list frequencies;
  for (const CalibratedFrequency& its : found.frequencies) {
    py::dict harmonics;
    for (const CalibratedHarmonic& h : its.harmonics)
      harmonics[py::int_(h.harmonic)] = py::make_tuple(pair_of(h.in_phase), pair_of(h.quadrature));
    py::dict frequency;
    frequency["frequency_hz"] = its.frequency_hz;
    frequency["offset_m"] = pair_of(its.offset_m);
    frequency["contrast"] = pair_of(its.contrast);
    frequency["harmonics"] = harmonics;
    frequencies.append(frequency);
  }
  py::dict dict;
  dict["reversed"] = found.reversed;
  dict["frequencies"] = frequencies;
  dict["terms"] = terms;
  dict["far_terms"] = found.far_terms;
  dict["known_share"] = found.known_share;
  dict["mean_error_m"] = found.mean_error_m;
  dict["rms_before_m"] = found.rms_before_m;
  dict["rms_m"] = found.rms_m;
  dict["far_rms_m"] = found.far_rms_m;
  dict["skipped_folds"] = found.skipped_folds;
  dict["outlier_share"] = found.outlier_share;
  dict["model_error_percent"] = found.model_error_percent;
  dict["pixels"] = found.pixels;
  dict["notes"] = found.notes;
  return dict;
}

TemperatureDrift calibrate_drift(const py::object& frames, const std::vector<double>& temperature_c,
                                 const std::vector<double>& sensor_temperature_c,
                                 const CodeSet& code, const Camera& camera,
                                 const py::object& callback) {
  const RawFrames raw = to_raw_frames(frames, "frames");
  return without_gil(callback, [&](const Progress& progress) {
    return calibrate_temperature(raw, {temperature_c, sensor_temperature_c}, code, camera,
                                 progress);
  });
}

CalibratedStrayLight calibrate_stray(const py::object& frames, const py::object& dark,
                                     const Camera& camera, const py::object& callback) {
  const RawFrames raw = to_raw_frames(frames, "frames");
  const RawFrames dark_frames = to_raw_frames(dark, "dark");
  return without_gil(callback, [&](const Progress& progress) {
    return calibrate_stray_light(raw, dark_frames, camera, progress);
  });
}

}  // namespace

void bind_delay_sweep(py::module_& module) {
  module.def("read_reference_depth", &read_reference);
  module.def("depth_kind_of", [](const std::string& path, const std::optional<std::string>& asked) {
    const auto kind = asked ? std::optional(parse_depth_kind(*asked)) : std::nullopt;
    return std::string(name_of(depth_kind_of(path, kind, DepthKind::radial)));
  });
  module.def("calibrate_depth", &calibrate_by_reference);
  py::class_<CalibratedDepth>(module, "CalibratedDepth")
      .def("fields", &depth_dict)
      .def("camera", [](const CalibratedDepth& found,
                        const Camera& camera) { return with_depth(camera, found); })
      .def("decoding_table",
           [](const CalibratedDepth& found, const Camera& camera) {
             return make_decoding_table(found.table, camera);
           })
      .def("write_table",
           [](const CalibratedDepth& found, const std::string& path, bool overwrite) {
             write_calibrated_table(path, found.table, policy_of(overwrite));
           })
      .def("write_report", writing(&depth_report));
  module.def("calibrate_stray_light", &calibrate_stray);
  py::class_<CalibratedStrayLight>(module, "CalibratedStrayLight")
      .def("fields", &fields_dict<CalibratedStrayLight>)
      .def("write",
           [](const CalibratedStrayLight& found, const std::string& path, bool overwrite) {
             write_float_image(path, found.kernel, "kernel", policy_of(overwrite));
           })
      .def("write_report", writing(&stray_light_report));
  module.def("calibrate_temperature", &calibrate_drift);
  py::class_<TemperatureDrift>(module, "TemperatureDrift")
      .def("fields", &fields_dict<TemperatureDrift>)
      .def("camera",
           [](const TemperatureDrift& found, const Camera& camera,
              std::optional<double> reference_c, std::optional<double> sensor_reference_c) {
             return with_temperature(camera, found, reference_c, sensor_reference_c);
           })
      .def("write_report", writing(&temperature_report));
  module.def("read_delay_sweep", &read_sweep);
  py::class_<CalibratedCorrelation>(module, "CalibratedCorrelation")
      .def("fields", &correlation_dict)
      .def("decoding_table",
           [](const CalibratedCorrelation& found, const Camera& camera) {
             return make_decoding_table(found.table, camera);
           })
      .def("write_table",
           [](const CalibratedCorrelation& found, const std::string& path, bool overwrite) {
             write_calibrated_table(path, found, policy_of(overwrite));
           });
  module.def("write_correlation_report",
             [](const std::string& path, const CalibratedCorrelation& found,
                const std::vector<IdealCodeFit>& fits, const std::string& source, bool overwrite) {
               write_page(path, correlation_report(found, fits, source, ""), overwrite);
             });
  module.def("calibrate_correlation", &calibrate);
  module.def("write_pixel_map", [](const std::string& path, const py::object& map,
                                   const std::string& name, bool overwrite) {
    write_float_image(path, to_image(map, name.c_str()), name, policy_of(overwrite));
  });
  py::class_<IdealCodeFit>(module, "IdealCodeFit")
      .def("fields", &fields_dict<IdealCodeFit>)
      .def("camera",
           [](const IdealCodeFit& fit, const Camera& camera, const CalibratedCorrelation& found) {
             return with_fit(camera, fit, found.tap_mismatch);
           });
  module.def("fit_ideal_codes", &fits_of);
}

}  // namespace tofsmith::python
