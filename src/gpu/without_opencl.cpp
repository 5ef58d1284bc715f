// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Replaces opencl.cpp in builds without OpenCL.
#include "gpu/device_queue.hpp"

namespace tofsmith {

namespace {

[[noreturn]] void refuse() {
  throw IoError("OpenCL",
                "this tofsmith was built without OpenCL; expected a build with "
                "TOFSMITH_USE_OPENCL=ON, which requires ocl-icd-opencl-dev");
}

}  // namespace

std::vector<Device> Device::all() { refuse(); }
const DeviceInfo& Device::info() const { refuse(); }

DeviceQueue::DeviceQueue(const Device& device) : device_(device) { refuse(); }
DeviceMemory DeviceQueue::allocate(std::size_t) const { refuse(); }
void DeviceQueue::upload(const void*, std::size_t, const DeviceMemory&) const { refuse(); }
void DeviceQueue::download(const DeviceMemory&, std::size_t, void*) const { refuse(); }
void DeviceQueue::copy(const DeviceMemory&, std::size_t, const DeviceMemory&, std::size_t,
                       std::size_t) const {
  refuse();
}
void DeviceQueue::clear(const DeviceMemory&) const { refuse(); }
DeviceKernel DeviceQueue::kernel(std::string_view, const std::string&, const char*) const {
  refuse();
}
void DeviceQueue::set(const DeviceKernel&, unsigned, const DeviceMemory*) const { refuse(); }
void DeviceQueue::set_bytes(const DeviceKernel&, unsigned, const void*, std::size_t) const {
  refuse();
}
void DeviceQueue::start(const DeviceKernel&, const Extent&, const Extent&) const { refuse(); }
DeviceMark DeviceQueue::mark() const { refuse(); }
void DeviceQueue::follow(const DeviceMark&) const { refuse(); }
void DeviceQueue::flush() const { refuse(); }
void DeviceQueue::finish() const { refuse(); }

}  // namespace tofsmith
