// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"
#include "bindings.hpp"
#include "tofsmith/simulate/bounds.hpp"

namespace tofsmith::python {

namespace {

/// Returns mae_m at a light level, with the signal scaled uniformly in (0, 1) if requested.
template <typename Bound>
double mae_m(const Bound& bound, double signal_e_per_s, double ambient_e_per_s,
             bool uniform_albedo) {
  const py::gil_scoped_release release;
  const OperatingPoint point{signal_e_per_s, ambient_e_per_s};
  return uniform_albedo ? bound.mae_uniform_albedo_m(point) : bound.mae_m(point);
}

}  // namespace

void bind_bounds(py::module_& module) {
  py::class_<CramerRaoBound>(module, "CramerRaoBound")
      .def(py::init([](const CodeSet& code, const Camera& camera, bool of_variance_too) {
        return CramerRaoBound(
            ForwardModel(code, camera), camera,
            of_variance_too ? NoiseInformation::mean_and_variance : NoiseInformation::mean);
      }))
      .def("sigma_m",
           [](const CramerRaoBound& bound, double signal_e_per_s, double ambient_e_per_s) {
             return adopt(bound.sigma_m({signal_e_per_s, ambient_e_per_s}));
           })
      .def("mae_m", &mae_m<CramerRaoBound>);
  py::class_<ReceiverBound>(module, "ReceiverBound")
      .def(py::init<const Camera&, int>())
      .def("mae_m", &mae_m<ReceiverBound>);
  py::class_<HistogramBound>(module, "HistogramBound")
      .def(py::init([](const CodeSet& code, const Camera& camera) {
        return HistogramBound(ForwardModel(code, camera), camera);
      }))
      .def("mae_m", &mae_m<HistogramBound>);
  py::class_<DirectTofBound>(module, "DirectTofBound")
      .def(py::init<const Camera&>())
      .def("mae_m", &mae_m<DirectTofBound>);
}

}  // namespace tofsmith::python
