// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "file_objects.hpp"

#include <pybind11/numpy.h>

#include <cstring>

#include "arrays.hpp"

namespace tofsmith::python {

namespace {

/// Provides bytes to a Python call, which cannot keep them.
class LentBytes {
 public:
  explicit LentBytes(std::span<std::byte> bytes)
      : view_(py::memoryview::from_memory(bytes.data(), std::ssize(bytes))) {}
  explicit LentBytes(std::span<const std::byte> bytes)
      : view_(py::memoryview::from_memory(static_cast<const void*>(bytes.data()),
                                          std::ssize(bytes))) {}
  LentBytes(const LentBytes&) = delete;
  LentBytes& operator=(const LentBytes&) = delete;
  /// An exporter that is still in use must not be released; this cannot be handled here.
  ~LentBytes() {
    const py::error_scope scope;
    if (PyObject* done = PyObject_CallMethod(view_.ptr(), "release", nullptr))
      Py_DECREF(done);
    else
      PyErr_Clear();
  }
  const py::memoryview& view() const { return view_; }

 private:
  py::memoryview view_;
};

/// Converts the results of readinto() and write().
std::size_t count_of(const py::object& said, std::size_t most, const char* argument) {
  if (said.is_none())
    refuse(argument, "None: a stream that does not wait", "one that waits until there is more");
  if (PyLong_Check(said.ptr()) == 0)
    refuse(argument, std::string(py::repr(said)) + " from it", "a number of bytes");
  const auto count = py::cast<long long>(said);
  if (count < 0 || static_cast<unsigned long long>(count) > most)
    refuse(argument, std::to_string(count) + " bytes from it",
           "at most " + std::to_string(most) + ", as asked for");
  return static_cast<std::size_t>(count);
}

std::size_t read_some(const py::object& source, std::span<std::byte> into) {
  if (py::hasattr(source, "readinto")) {
    const LentBytes bytes(into);
    return count_of(source.attr("readinto")(bytes.view()), into.size(), "source");
  }
  const py::object read = source.attr("read")(into.size());
  if (PyBytes_Check(read.ptr()) == 0)
    refuse("source", std::string(py::repr(py::type::of(read))) + " from its read()", "bytes");
  const auto bytes = py::reinterpret_borrow<py::bytes>(read);
  const std::string_view found = bytes;
  if (found.size() > into.size())
    refuse("source", std::to_string(found.size()) + " bytes from its read()",
           "at most " + std::to_string(into.size()) + ", as asked for");
  std::memcpy(into.data(), found.data(), found.size());
  return found.size();
}

py::array array_of(DecodedPlane plane, std::span<const std::byte> bytes, int height, int width) {
  py::array array(py::dtype(std::string(name_of(type_of(plane)))), {height, width});
  std::memcpy(array.mutable_data(), bytes.data(), bytes.size());
  return array;
}

}  // namespace

ReadStream reading_from(const py::object& source) {
  return [&source](std::span<std::byte> into) {
    const py::gil_scoped_acquire gil;
    std::size_t done = 0;
    while (done < into.size()) {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      const std::size_t count = read_some(source, into.subspan(done));
      if (count == 0) break;
      done += count;
    }
    return done;
  };
}

WriteStream FrameSink::stream() {
  return [this](std::span<const std::byte> plane) {
    const py::gil_scoped_acquire gil;
    if (write_.is_none()) {
      keep(plane);
      return;
    }
    while (!plane.empty()) {
      const LentBytes bytes(plane);
      plane = plane.subspan(count_of(write_(bytes.view()), plane.size(), "sink"));
    }
  };
}

void FrameSink::keep(std::span<const std::byte> plane) {
  const DecodedPlane which = planes_[next_];
  frame_[py::str(std::string(name_of(which)))] =
      array_of(which, plane, result_.height, result_.width);
  next_ = (next_ + 1) % planes_.size();
  if (next_ != 0) return;
  const py::dict whole = std::exchange(frame_, py::dict());
  if (take_(whole).ptr() == Py_False) throw Stopped();
}

}  // namespace tofsmith::python
