// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <vector>

#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith::python {

namespace py = pybind11;

/// Reads a binary file object of Python with its readinto(), or else its read(). Needs no GIL.
ReadStream reading_from(const py::object& source);

/// Passes frames of decode_stream() to Python: the bytes of each plane to `write`, or a dict of
/// arrays (H, W) by the words of the planes to `take`; one of the two is None. Needs no GIL.
class FrameSink {
 public:
  /// Thrown through decode_stream() once `take` has returned False.
  struct Stopped {};

  /// @param result  of decode_stream(), contains the size of the frames
  FrameSink(py::object take, py::object write, std::vector<DecodedPlane> planes,
            const DecodedStream& result)
      : take_(std::move(take)),
        write_(std::move(write)),
        planes_(std::move(planes)),
        result_(result) {}

  WriteStream stream();

 private:
  void keep(std::span<const std::byte> plane);

  py::object take_, write_;
  std::vector<DecodedPlane> planes_;
  const DecodedStream& result_;
  std::size_t next_ = 0;  // of planes_
  py::dict frame_;
};

}  // namespace tofsmith::python
