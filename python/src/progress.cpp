// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "progress.hpp"

namespace tofsmith::python {

bool ProgressBridge::call(double fraction, std::string_view step) {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_ && fraction < 1.0) return true;
  next_ = now + std::chrono::milliseconds(20);
  const py::gil_scoped_acquire gil;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    return callback_.is_none() ||
           callback_(fraction, py::str(step.data(), step.size())).ptr() != Py_False;
  } catch (...) {
    error_ = std::current_exception();
    return false;
  }
}

}  // namespace tofsmith::python
