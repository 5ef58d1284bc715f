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

/// Less memory on a device than was asked for; smaller parts may do.
class OutOfDeviceMemory : public IoError {
 public:
  using IoError::IoError;
};

/// What a backend made, given back with this.
using DeviceHandle = std::unique_ptr<void, void (*)(void*)>;
inline DeviceHandle no_handle() {
  return {nullptr, [](void*) {}};
}

/// Memory of a device, freed with this; at first none.
struct DeviceMemory {
  DeviceHandle handle = no_handle();
  std::size_t bytes = 0;
};

/// A function that a device runs for many items.
struct DeviceKernel {
  DeviceHandle handle = no_handle();
};

/// A point in the work of a queue.
struct DeviceMark {
  DeviceHandle handle = no_handle();
};

/// What a backend does: work of a device, one piece after another. Every call throws IoError if the
/// device fails, OutOfDeviceMemory where it is for that.
class DeviceQueue {
 public:
  /// Columns and rows of items.
  using Extent = std::array<std::size_t, 2>;
  /// Items of a kernel that run together; kernels are started for whole groups.
  static constexpr std::size_t group_items = 64;

  explicit DeviceQueue(const Device& device);

  DeviceMemory allocate(std::size_t bytes) const;
  void upload(const void* from, std::size_t bytes, const DeviceMemory& to) const;
  /// @param bytes  of the first of `from`
  void download(const DeviceMemory& from, std::size_t bytes, void* to) const;
  /// @param first  byte of `from`, which goes to `first_there`
  void copy(const DeviceMemory& from, std::size_t first, const DeviceMemory& to,
            std::size_t first_there, std::size_t bytes) const;
  /// Zeroes all of it.
  void clear(const DeviceMemory& memory) const;
  /// Compiled once for a device and these options.
  DeviceKernel kernel(std::string_view source, const std::string& options, const char* name) const;
  /// Runs a kernel for items 0, 1, .. of whole groups.
  /// @param arguments  numbers and structs by value; memory, or null where it may be, by pointer
  template <typename... Arguments>
  void run(const DeviceKernel& kernel, std::int64_t items, const Arguments&... arguments) const {
    set_all(kernel, arguments...);
    start(kernel, {static_cast<std::size_t>(items), 1}, {group_items, 1});
  }
  /// The same for the pixels of a picture, column and row of each, in whole tiles of `group`.
  template <typename... Arguments>
  void run(const DeviceKernel& kernel, const Extent& pixels, const Extent& group,
           const Arguments&... arguments) const {
    set_all(kernel, arguments...);
    start(kernel, pixels, group);
  }
  /// The work given so far, which the device begins with.
  DeviceMark mark() const;
  /// What comes next begins once that work, of another queue, is done. Nobody waits here.
  void follow(const DeviceMark& mark) const;
  /// Has the device begin with what it was given.
  void flush() const;
  /// Waits until all work is done.
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
