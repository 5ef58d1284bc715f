// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/io/code_file.hpp"

namespace tofsmith::python {

namespace {

/// Converts samples with two levels, the lower of which is 0, to switching times, as for NPZ files.
Waveform waveform_of(const Eigen::VectorXd& samples) {
  const double peak = samples.maxCoeff();
  for (const double value : samples)
    if (value != 0.0 && value != peak) return Waveform::sampled(samples);
  return peak > 0.0 ? Waveform::binary_from_samples(samples, peak) : Waveform::sampled(samples);
}

std::vector<Waveform> waveforms_of(const Eigen::MatrixXd& columns) {
  std::vector<Waveform> waveforms;
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    waveforms.push_back(waveform_of(columns.col(i)));
  return waveforms;
}

CodeSet code_from_arrays(const std::string& name, const Doubles& modulation,
                         const Doubles& demodulation, int taps, bool is_signed) {
  const Eigen::MatrixXd m = to_matrix(modulation, "modulation");
  const Eigen::MatrixXd d = to_matrix(demodulation, "demodulation");
  if (m.size() == 0) refuse("modulation", "shape " + shape_of(modulation), "(N, E), not empty");
  if (d.rows() != m.rows() || d.cols() != m.cols() * taps)
    refuse("demodulation", "shape " + shape_of(demodulation),
           "(" + std::to_string(m.rows()) + ", " + std::to_string(m.cols() * taps) +
               "), as modulation has shape " + shape_of(modulation) +
               " and taps = " + std::to_string(taps));
  if (is_signed) return CodeSet::create_signed(name, waveforms_of(m), d);
  return CodeSet::create(name, static_cast<int>(m.rows()), taps, waveforms_of(m), waveforms_of(d));
}

CodeSet rows_from_arrays(const std::string& name, const Doubles& light, const Doubles& rows) {
  const Eigen::MatrixXd m = to_matrix(light, "light");
  return CodeSet::create_rows(name, Eigen::VectorXd(m.reshaped()), to_matrix(rows, "rows"));
}

Waveform binary(const Doubles& on_intervals, double level) {
  const Eigen::MatrixXd on = to_matrix(on_intervals, "on_intervals");
  if (on.cols() != 2) refuse("on_intervals", "shape " + shape_of(on_intervals), "(intervals, 2)");
  std::vector<OnInterval> intervals;
  for (Eigen::Index i = 0; i < on.rows(); ++i) intervals.push_back({on(i, 0), on(i, 1)});
  return Waveform::binary(std::move(intervals), level);
}

Eigen::MatrixXd on_intervals(const Waveform& waveform) {
  const std::vector<OnInterval>& on = waveform.on_intervals();
  Eigen::MatrixXd intervals(static_cast<Eigen::Index>(on.size()), 2);
  for (std::size_t i = 0; i < on.size(); ++i)
    intervals.row(static_cast<Eigen::Index>(i)) << on[i].rise, on[i].fall;
  return intervals;
}

std::optional<TapOrder> order_of(const std::optional<std::string>& word) {
  return word ? std::optional(parse_word<TapOrder>("tap order", *word)) : std::nullopt;
}

py::dict provenance_of(const CodeSet& code) {
  const Provenance& p = code.provenance;
  py::dict dict;
  dict["method"] = p.method;
  dict["camera"] = p.camera;
  dict["seed"] = p.seed;
  dict["version"] = p.version;
  dict["residuals"] = p.residuals;
  dict["depth_error_m"] = p.depth_error_m;
  return dict;
}

void bind_waveform(py::module_& module) {
  py::class_<Waveform>(module, "Waveform")
      .def_static("binary", &binary)
      .def_static("sampled",
                  [](const Doubles& samples) { return Waveform::sampled(to_vector(samples)); })
      .def_static("cosines",
                  [](const std::vector<std::complex<double>>& c) {
                    return Waveform::cosines(Eigen::Map<const Eigen::VectorXcd>(
                        c.data(), static_cast<Eigen::Index>(c.size())));
                  })
      .def("is_binary", &Waveform::is_binary)
      .def("on_intervals", [](const Waveform& w) { return adopt(on_intervals(w)); })
      .def("level", &Waveform::level)
      .def("samples", [](const Waveform& w) { return adopt(Eigen::VectorXd(w.samples())); })
      .def("coefficients",
           [](const Waveform& w) {
             const Eigen::VectorXcd& c = w.coefficients();
             return adopt(std::vector<std::complex<double>>(c.begin(), c.end()));
           })
      .def("mean", &Waveform::mean)
      .def("peak", &Waveform::peak)
      .def("duty", &Waveform::duty)
      .def("edges", &Waveform::edges)
      .def("cell_averages",
           [](const Waveform& w, int samples) { return adopt(w.cell_averages(samples)); })
      .def("delayed", &Waveform::delayed)
      .def("complement", &Waveform::complement)
      .def("is_equal", [](const Waveform& a, const Waveform& b) { return a == b; });
}

void bind_code_set(py::module_& module) {
  py::class_<CodeSet>(module, "CodeSet")
      .def_static("create", &CodeSet::create)
      .def_static("from_rows", &rows_from_arrays)
      .def_static("from_arrays", &code_from_arrays)
      .def_static("parse", [](const std::string& json,
                              const std::string& file) { return parse_code_json(json, file); })
      .def("to_json", [](const CodeSet& code) { return code_to_json(code); })
      .def("name", &CodeSet::name)
      .def("samples", &CodeSet::samples)
      .def("taps", &CodeSet::taps)
      .def("is_rows", &CodeSet::is_rows)
      .def("is_signed", &CodeSet::is_signed)
      .def("exposures", &CodeSet::exposures)
      .def("measurements", &CodeSet::measurements)
      .def("peak", &CodeSet::peak)
      .def("modulation", [](const CodeSet& code, int e) { return Waveform(code.modulation(e)); })
      .def("demodulation",
           [](const CodeSet& code, int i) { return Waveform(code.demodulation(i)); })
      .def("modulation_samples",
           [](const CodeSet& code) { return adopt(code.modulation_samples()); })
      .def("demodulation_samples",
           [](const CodeSet& code) { return adopt(code.demodulation_samples()); })
      .def("renamed", &CodeSet::renamed)
      .def("resampled", &CodeSet::resampled)
      .def("rotated", &CodeSet::rotated)
      .def("exposure_shares", &CodeSet::exposure_shares)
      .def("with_exposure_shares", &CodeSet::with_exposure_shares)
      .def("with_two_buckets", &CodeSet::with_two_buckets)
      .def("with_signed_weights", &CodeSet::with_signed_weights)
      .def("provenance", &provenance_of);
}

}  // namespace

void bind_code(py::module_& module) {
  bind_waveform(module);
  bind_code_set(module);
  module.def("list_families", [] {
    std::vector<std::tuple<std::string, std::string, std::string>> families;
    for (const FamilyDescription& family : list_families())
      families.emplace_back(family.name, family.example, family.description);
    return families;
  });
  module.def("build_family", [](const std::string& name, const Camera& camera) {
    return build_family(name, camera);
  });
  module.def("require_fits", &require_fits);
  module.def("why_not_playable", &why_not_playable);
  module.def("load_code",
             [](const std::string& name, const Camera& camera, const std::optional<int>& taps,
                const std::optional<std::string>& tap_order) {
               return load_code(name, camera, {taps, order_of(tap_order)});
             });
  module.def("read_code",
             [](const std::string& path, int taps, const std::optional<std::string>& tap_order) {
               return read_code(path, {taps, order_of(tap_order)});
             });
  module.def("write_code", [](const std::string& path, const CodeSet& code, bool overwrite,
                              const std::optional<std::string>& tap_order) {
    write_code(path, code, overwrite ? OutputPolicy::overwrite : OutputPolicy::refuse_existing,
               order_of(tap_order));
  });
  module.def("coding_curve_length",
             [](const Doubles& table) { return coding_curve_length(to_matrix(table, "table")); });
  module.def("harmonics_used", [](const Doubles& table, double share) {
    return harmonics_used(to_matrix(table, "table"), share);
  });
  module.def("coding_curve_in_space", [](const Doubles& table) {
    return adopt(coding_curve_in_space(to_matrix(table, "table")));
  });
  module.def("coding_curve_rank", [](const Doubles& table, double tolerance) {
    return coding_curve_rank(to_matrix(table, "table"), tolerance);
  });
}

}  // namespace tofsmith::python
