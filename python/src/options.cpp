// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tofsmith/core/error.hpp"

namespace tofsmith::python {

std::string shown(py::handle value) {
  std::string content = py::repr(value);
  constexpr std::size_t longest = 60;
  if (content.size() > longest) content = content.substr(0, longest) + "..";
  return std::string(py::str(py::type::handle_of(value).attr("__name__"))) + " " + content;
}

OptionReader::OptionReader(const py::dict& values, std::string owner)
    : values_(values.attr("copy")()), owner_(std::move(owner)) {}

py::dict OptionReader::table(const char* name) {
  const py::object given = take(name);
  if (given.is_none()) return {};
  if (!py::isinstance<py::dict>(given)) wrong_type(name, given, "a dict of options");
  return py::dict(given);
}

py::object whole_number_of(const py::object& given) {
  if (PyFloat_Check(given.ptr()) == 0 || !py::cast<bool>(given.attr("is_integer")())) return given;
  return py::reinterpret_steal<py::object>(PyNumber_Long(given.ptr()));
}

py::object as_numbers(const py::object& given, bool whole) {
  if (py::isinstance<py::bool_>(given) || py::isinstance<py::str>(given)) return given;
  py::list numbers;
  if (PySequence_Check(given.ptr()) == 0) {
    if (PyNumber_Check(given.ptr()) == 0) return given;
    numbers.append(given);
  } else {
    for (const py::handle item : given) numbers.append(item);
  }
  if (whole)
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = whole_number_of(numbers[i]);
  return numbers;
}

void OptionReader::finish() const {
  for (const auto& entry : values_) {
    const std::string name = py::str(entry.first);
    const std::string near = nearest_word(name, known_);
    std::string needs = fmt::format("one of {}", fmt::join(known_, ", "));
    if (!near.empty()) needs.append("; did you mean ").append(near).append("?");
    refuse(owner_.empty() ? "options" : owner_, "the unknown name '" + name + "'", needs);
  }
}

OptionReader& OptionReader::path(const char* name, std::filesystem::path& field) {
  const py::object given = take(name);
  if (given.is_none()) return *this;
  const auto text = py::reinterpret_steal<py::object>(PyOS_FSPath(given.ptr()));
  if (!text) PyErr_Clear();
  if (!text || !py::isinstance<py::str>(text)) wrong_type(name, given, "the name of a file");
  const auto file = py::cast<std::string>(text);
  if (file.find('\0') != std::string::npos) wrong_type(name, given, "the name of a file as text");
  field = file;
  return *this;
}

py::object OptionReader::take(const char* name) {
  known_.emplace_back(name);
  return values_.attr("pop")(name, py::none());
}

void OptionReader::wrong_type(const char* name, py::handle given, const std::string& needs) const {
  std::string text = full_name(name);
  text.append(": got ").append(shown(given)).append("; needs ").append(needs);
  const bool is_out_of_range = PyLong_Check(given.ptr()) && needs.starts_with("a whole number");
  PyErr_SetString(is_out_of_range ? PyExc_ValueError : PyExc_TypeError, text.c_str());
  throw py::error_already_set();
}

std::string OptionReader::full_name(const std::string& name) const {
  return owner_.empty() ? name : owner_ + "." + name;
}

MultipathOptions multipath_options(const py::dict& values, const std::string& owner,
                                   double range_m) {
  MultipathOptions options;
  OptionReader(values, owner).fields(options, {"status_thresholds"}).finish();
  options.validate(range_m);
  return options;
}

}  // namespace tofsmith::python
