// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

#include "tofsmith/core/error.hpp"
#include "tofsmith/gpu.hpp"

namespace tofsmith {

/// Too little device memory; smaller parts may fit.
class OutOfDeviceMemory : public IoError {
 public:
  using IoError::IoError;
};

/// An OpenCL object, released by the destructor.
using DeviceHandle = std::unique_ptr<void, void (*)(void*)>;
inline DeviceHandle no_handle() {
  return {nullptr, [](void*) {}};
}

/// Device memory, freed by the destructor.
struct DeviceMemory {
  DeviceHandle handle = no_handle();
  std::size_t bytes = 0;
};

struct DeviceKernel {
  DeviceHandle handle = no_handle();
};

struct DeviceMark {
  DeviceHandle handle = no_handle();
};

/// In-order queue of work for a device. Calls throw IoError if the device fails, OutOfDeviceMemory
/// if memory is the cause.
class DeviceQueue {
 public:
  using Extent = std::array<std::size_t, 2>;
  /// Work items per group.
  static constexpr std::size_t group_items = 64;

  explicit DeviceQueue(const Device& device);

  DeviceMemory allocate(std::size_t bytes) const;
  void upload(const void* from, std::size_t bytes, const DeviceMemory& to) const;
  void download(const DeviceMemory& from, std::size_t bytes, void* to) const;
  /// @param first  offset in `from` [bytes]; `first_there`: offset in `to`
  void copy(const DeviceMemory& from, std::size_t first, const DeviceMemory& to,
            std::size_t first_there, std::size_t bytes) const;
  void clear(const DeviceMemory& memory) const;
  /// Returns a kernel, compiled once per device and options.
  DeviceKernel kernel(std::string_view source, const std::string& options, const char* name) const;
  /// Runs a kernel for `items` work items, rounded up to whole groups.
  /// @param arguments  numbers and structs by value; memory by pointer, may be null
  template <typename... Arguments>
  void run(const DeviceKernel& kernel, std::int64_t items, const Arguments&... arguments) const {
    set_all(kernel, arguments...);
    start(kernel, {static_cast<std::size_t>(items), 1}, {group_items, 1});
  }
  /// As above for an image, rounded up to whole tiles of `group`.
  template <typename... Arguments>
  void run(const DeviceKernel& kernel, const Extent& pixels, const Extent& group,
           const Arguments&... arguments) const {
    set_all(kernel, arguments...);
    start(kernel, pixels, group);
  }
  /// Submits the enqueued work and returns a mark after it.
  DeviceMark mark() const;
  /// Makes later work wait for a mark of another queue, without blocking the host.
  void follow(const DeviceMark& mark) const;
  void flush() const;
  void finish() const;

 private:
  void set(const DeviceKernel& kernel, unsigned at, const DeviceMemory* memory) const;
  void set_bytes(const DeviceKernel& kernel, unsigned at, const void* value,
                 std::size_t bytes) const;
  template <typename Value>
  requires(!std::is_pointer_v<Value>) void set(const DeviceKernel& kernel, unsigned at,
                                               const Value& value) const {
    set_bytes(kernel, at, &value, sizeof(Value));
  }
  template <typename... Arguments>
  void set_all(const DeviceKernel& kernel, const Arguments&... arguments) const {
    unsigned at = 0;
    (set(kernel, at++, arguments), ...);
  }
  void start(const DeviceKernel& kernel, const Extent& items, const Extent& group) const;

  Device device_;
  DeviceHandle handle_ = no_handle();
};

}  // namespace tofsmith
