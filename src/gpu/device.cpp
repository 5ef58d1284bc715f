// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>

#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/gpu.hpp"

namespace tofsmith {

namespace {

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& letter : small) letter = lower_case(letter);
  return small;
}

std::string list_of(const std::vector<Device>& devices) {
  if (devices.empty()) return std::string(Device::none_found());
  std::string list = "expected one of";
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& info = devices[i].info();
    list += fmt::format("{} {} {} ({})", i > 0 ? "," : "", i, info.name, name_of(info.kind));
  }
  return list;
}

bool is_called(const DeviceInfo& info, const std::string& part) {
  return in_small_letters(info.name).find(part) != std::string::npos ||
         in_small_letters(info.platform).find(part) != std::string::npos;
}

}  // namespace

std::string_view name_of(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::gpu:
      return "gpu";
    case DeviceKind::cpu:
      return "cpu";
    case DeviceKind::other:
      break;
  }
  return "other";
}

std::string_view Device::none_found() {
  return "OpenCL finds no device: no driver is installed (on Debian, pocl-opencl-icd for the CPU; "
         "for a GPU, the vendor's driver), or it cannot start (pocl requires a writable folder for "
         "kernels, POCL_CACHE_DIR)";
}

Device Device::named(std::string_view name) {
  const std::vector<Device> devices = all();
  std::size_t number = 0;
  const auto read = std::from_chars(name.data(), name.data() + name.size(), number);
  if (!name.empty() && read.ec == std::errc() && read.ptr == name.data() + name.size()) {
    if (number < devices.size()) return devices[number];
  } else if (!name.empty()) {
    const std::string part = in_small_letters(name);
    for (const Device& device : devices)
      if (part == "gpu" ? device.info().kind == DeviceKind::gpu : is_called(device.info(), part))
        return device;
  }
  throw IoError(fmt::format("device {}", name),
                (devices.empty() ? "" : "found no such device; ") + list_of(devices));
}

std::optional<Device> Device::first_gpu() {
  try {
    for (const Device& device : all())
      if (device.info().kind == DeviceKind::gpu) return device;
    return std::nullopt;
  } catch (const IoError&) {
    return std::nullopt;  // no OpenCL, or a driver failed
  }
}

}  // namespace tofsmith
