// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <optional>
#include <tuple>

#include "arrays.hpp"
#include "bindings.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/design/code_gradients.hpp"

// The steps of tofsmith.torch, which checks and reshapes the arguments: arrays of B codes in C
// order, (B, N, K) for tables, (B, P, K) for measurements, (B, P) for light.
namespace tofsmith::python {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Shape = std::vector<py::ssize_t>;

/// Returns matrix, vector or numbers b of an array.
Eigen::Map<const RowMajor> matrix_of(const Doubles& values, py::ssize_t b) {
  return {values.data() + b * values.shape(1) * values.shape(2), values.shape(1), values.shape(2)};
}
Eigen::Map<const Eigen::VectorXd> vector_of(const Doubles& values, py::ssize_t b) {
  return {values.data() + b * values.shape(1), values.shape(1)};
}
template <typename Array>
std::span<const typename Array::value_type> span_of(const Array& values, py::ssize_t b) {
  const auto size = static_cast<std::size_t>(values.size() / values.shape(0));
  return {values.data() + static_cast<std::size_t>(b) * size, size};
}
/// Requires exactly this type, because threads without the interpreter's lock must not convert
/// arrays.
template <typename Value>
using Measured = py::array_t<Value, py::array::c_style>;

/// Writes the result for code b into an array.
template <typename Value, typename Matrix>
void put(Value* data, py::ssize_t b, const Matrix& matrix) {
  using Rows = Eigen::Matrix<Value, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Map<Rows>(data + b * matrix.size(), matrix.rows(), matrix.cols()) = matrix;
}

/// Tables of B codes.
struct TableArrays {
  Doubles correlation, ambient_gain;
  std::optional<Doubles> shot_correlation, shot_ambient_gain;

  py::ssize_t codes() const { return correlation.shape(0); }
  MeasurementTable at(py::ssize_t b) const {
    MeasurementTable table{matrix_of(correlation, b), vector_of(ambient_gain, b), {}, {}};
    if (!shot_correlation) return table;
    table.shot_correlation = matrix_of(*shot_correlation, b);
    table.shot_ambient_gain = vector_of(*shot_ambient_gain, b);
    return table;
  }
};
using TableTuple = std::tuple<Doubles, Doubles, std::optional<Doubles>, std::optional<Doubles>>;
TableArrays arrays_of(const TableTuple& table) {
  return {std::get<0>(table), std::get<1>(table), std::get<2>(table), std::get<3>(table)};
}

/// Tables computed code by code; any thread may write to them.
class MadeTables {
 public:
  MadeTables(const CodeGradients& steps, py::ssize_t codes)
      : correlation_(Shape{codes, steps.samples(), steps.measurements()}),
        ambient_gain_(Shape{codes, steps.measurements()}) {
    if (steps.has_shot()) {
      shot_correlation_.emplace(Shape{codes, steps.samples(), steps.measurements()});
      shot_ambient_gain_.emplace(Shape{codes, steps.measurements()});
      shot_data_ = shot_correlation_->mutable_data();
      shot_ambient_data_ = shot_ambient_gain_->mutable_data();
    }
    data_ = correlation_.mutable_data();
    ambient_data_ = ambient_gain_.mutable_data();
  }
  void put_table(py::ssize_t b, const MeasurementTable& table) {
    put(data_, b, table.correlation);
    put(ambient_data_, b, table.ambient_gain);
    if (!shot_data_) return;
    put(shot_data_, b, table.shot_correlation);
    put(shot_ambient_data_, b, table.shot_ambient_gain);
  }
  TableTuple tuple() const {
    return {correlation_, ambient_gain_, shot_correlation_, shot_ambient_gain_};
  }

 private:
  Doubles correlation_, ambient_gain_;
  std::optional<Doubles> shot_correlation_, shot_ambient_gain_;
  double *data_ = nullptr, *ambient_data_ = nullptr;
  double *shot_data_ = nullptr, *shot_ambient_data_ = nullptr;
};

/// Processes every code without the interpreter's lock.
template <typename Work>
void for_each_code(py::ssize_t codes, const Work& work) {
  const py::gil_scoped_release release;
  parallel_for(codes, work);
}

PixelLight light_of(const Doubles& depth_bin, const Doubles& signal, const Doubles& ambient,
                    py::ssize_t b) {
  return {span_of(depth_bin, b), span_of(signal, b), span_of(ambient, b)};
}

TableTuple measure(const CodeGradients& steps, const Doubles& modulation,
                   const Doubles& demodulation) {
  MadeTables made(steps, modulation.shape(0));
  for_each_code(modulation.shape(0), [&](std::int64_t b) {
    made.put_table(b, steps.measure(matrix_of(modulation, b), matrix_of(demodulation, b)));
  });
  return made.tuple();
}

py::tuple pull_back(const CodeGradients& steps, const Doubles& modulation,
                    const Doubles& demodulation, const TableTuple& by_table) {
  const TableArrays tables = arrays_of(by_table);
  Doubles by_modulation(Shape{tables.codes(), steps.samples(), steps.exposures()});
  Doubles by_demodulation(Shape{tables.codes(), steps.samples(), steps.tap_values()});
  double *const first = by_modulation.mutable_data(), *const second =
                                                          by_demodulation.mutable_data();
  for_each_code(tables.codes(), [&](std::int64_t b) {
    const auto [by_m, by_d] =
        steps.pull_back(matrix_of(modulation, b), matrix_of(demodulation, b), tables.at(b));
    put(first, b, by_m);
    put(second, b, by_d);
  });
  return py::make_tuple(by_modulation, by_demodulation);
}

py::tuple electrons(const CodeGradients& steps, const TableTuple& table, const Doubles& depth_bin,
                    const Doubles& signal, const Doubles& ambient) {
  const TableArrays tables = arrays_of(table);
  const Shape shape{tables.codes(), depth_bin.shape(1), steps.measurements()};
  Doubles mean(shape), variance(shape);
  double *const first = mean.mutable_data(), *const second = variance.mutable_data();
  for_each_code(tables.codes(), [&](std::int64_t b) {
    CodeGradients::Rows mean_e, variance_e2;
    steps.electrons(tables.at(b), light_of(depth_bin, signal, ambient, b), mean_e, variance_e2);
    put(first, b, mean_e);
    put(second, b, variance_e2);
  });
  return py::make_tuple(mean, variance);
}

py::tuple pull_back_electrons(const CodeGradients& steps, const TableTuple& table,
                              const Doubles& depth_bin, const Doubles& signal,
                              const Doubles& ambient, const Doubles& by_mean,
                              const Doubles& by_variance, bool of_table, bool of_light,
                              bool of_depth) {
  const TableArrays tables = arrays_of(table);
  MadeTables made(steps, tables.codes());
  const Shape shape{tables.codes(), depth_bin.shape(1)};
  Doubles by_depth(shape), by_signal(shape), by_ambient(shape);
  double* const light[] = {by_depth.mutable_data(), by_signal.mutable_data(),
                           by_ambient.mutable_data()};
  for_each_code(tables.codes(), [&](std::int64_t b) {
    const PixelGradient gradient = steps.pull_back_electrons(
        tables.at(b), light_of(depth_bin, signal, ambient, b), matrix_of(by_mean, b),
        matrix_of(by_variance, b), {of_table, of_light, of_depth});
    made.put_table(b, gradient.table);
    put(light[0], b, gradient.depth_bin);
    put(light[1], b, gradient.signal_e_per_s);
    put(light[2], b, gradient.ambient_e_per_s);
  });
  return py::make_tuple(made.tuple(), by_depth, by_signal, by_ambient);
}

std::span<const double> truth_of(const std::optional<Doubles>& true_bin, py::ssize_t b) {
  if (!true_bin) return {};
  return span_of(*true_bin, b);
}

template <typename Value>
Doubles decoded(const CodeGradients& steps, const TableTuple& table,
                const Measured<Value>& electrons, const Doubles& temperature_e2, bool circular,
                const std::optional<Doubles>& true_bin) {
  const TableArrays tables = arrays_of(table);
  Doubles answers(Shape{tables.codes(), electrons.shape(1)});
  double* const data = answers.mutable_data();
  for_each_code(tables.codes(), [&](std::int64_t b) {
    const SoftDecoding decoding{span_of(temperature_e2, b), circular};
    const std::vector<double> of_code =
        true_bin
            ? steps.soft_error(tables.at(b), span_of(electrons, b), decoding, truth_of(true_bin, b))
            : steps.soft_decode(tables.at(b), span_of(electrons, b), decoding);
    std::copy(of_code.begin(), of_code.end(), data + b * electrons.shape(1));
  });
  return answers;
}

template <typename Value>
py::tuple pull_back_decoded(const CodeGradients& steps, const TableTuple& table,
                            const Measured<Value>& electrons, const Doubles& temperature_e2,
                            bool circular, const std::optional<Doubles>& true_bin,
                            const Doubles& weight) {
  const TableArrays tables = arrays_of(table);
  MadeTables made(steps, tables.codes());
  Measured<Value> by_electrons(Shape{electrons.shape(0), electrons.shape(1), electrons.shape(2)});
  Value* const data = by_electrons.mutable_data();
  for_each_code(tables.codes(), [&](std::int64_t b) {
    const DecodedGradient<Value> gradient = steps.pull_back_decoded(
        tables.at(b), span_of(electrons, b), SoftDecoding{span_of(temperature_e2, b), circular},
        truth_of(true_bin, b), span_of(weight, b));
    made.put_table(b, gradient.table);
    std::copy(gradient.electrons.begin(), gradient.electrons.end(),
              data + b * electrons.shape(1) * electrons.shape(2));
  });
  return py::make_tuple(made.tuple(), by_electrons);
}

std::vector<OperatingPoint> points_of(const Doubles& signal, const Doubles& ambient,
                                      py::ssize_t b) {
  std::vector<OperatingPoint> points;
  for (py::ssize_t l = 0; l < signal.shape(1); ++l) {
    const py::ssize_t at = b * signal.shape(1) + l;
    points.push_back({signal.data()[at], ambient.data()[at]});
  }
  return points;
}

/// Converts lights (B, L) to deviations (B, L, 4 N).
Doubles depth_deviation_m(const CodeGradients& steps, const TableTuple& table,
                          const Doubles& signal, const Doubles& ambient) {
  const TableArrays tables = arrays_of(table);
  Doubles deviation(Shape{tables.codes(), signal.shape(1), 4 * steps.samples()});
  double* const data = deviation.mutable_data();
  for_each_code(tables.codes(), [&](std::int64_t b) {
    const Eigen::MatrixXd of_code =
        steps.depth_deviation_m(tables.at(b), points_of(signal, ambient, b));
    std::copy_n(of_code.data(), of_code.size(), data + b * of_code.size());
  });
  return deviation;
}

py::tuple pull_back_depth_deviation(const CodeGradients& steps, const TableTuple& table,
                                    const Doubles& signal, const Doubles& ambient,
                                    const Doubles& by_deviation) {
  const TableArrays tables = arrays_of(table);
  MadeTables made(steps, tables.codes());
  const Shape shape{tables.codes(), signal.shape(1)};
  Doubles by_signal(shape), by_ambient(shape);
  double *const first = by_signal.mutable_data(), *const second = by_ambient.mutable_data();
  for_each_code(tables.codes(), [&](std::int64_t b) {
    const PixelGradient gradient = steps.pull_back_depth_deviation(
        tables.at(b), points_of(signal, ambient, b), matrix_of(by_deviation, b).transpose());
    made.put_table(b, gradient.table);
    put(first, b, gradient.signal_e_per_s);
    put(second, b, gradient.ambient_e_per_s);
  });
  return py::make_tuple(made.tuple(), by_signal, by_ambient);
}

}  // namespace

void bind_gradients(py::module_& module) {
  py::class_<CodeGradients>(module, "CodeGradients")
      .def(py::init<const Camera&, int, int>())
      .def("measurements", &CodeGradients::measurements)
      .def(
          "dark_electrons",
          [](const CodeGradients& steps) { return adopt(Eigen::VectorXd(steps.dark_electrons())); })
      .def("measure", &measure)
      .def("pull_back", &pull_back)
      .def("electrons", &electrons)
      .def("pull_back_electrons", &pull_back_electrons)
      .def("decoded", &decoded<float>)
      .def("decoded", &decoded<double>)
      .def("pull_back_decoded", &pull_back_decoded<float>)
      .def("pull_back_decoded", &pull_back_decoded<double>)
      .def("depth_deviation_m", &depth_deviation_m)
      .def("pull_back_depth_deviation", &pull_back_depth_deviation);
}

}  // namespace tofsmith::python
