// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "device_arguments.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "help_pages.hpp"
#include "session.hpp"

namespace tofsmith::apps {

namespace {

void list_devices(bool as_json) {
  const std::vector<Device> devices = Device::all();
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Device& device : devices) {
    const DeviceInfo& info = device.info();
    list.push_back({{"name", info.name},
                    {"kind", name_of(info.kind)},
                    {"memory_bytes", info.memory_bytes},
                    {"doubles", info.has_doubles},
                    {"platform", info.platform},
                    {"version", info.version}});
    if (!as_json)
      fmt::print("{}  {} ({}, {:.1f} GB, {}): {}, {}\n", list.size() - 1, info.name,
                 name_of(info.kind), 1e-9 * static_cast<double>(info.memory_bytes),
                 info.has_doubles ? "doubles" : "no doubles", info.platform, info.version);
  }
  if (as_json)
    fmt::print("{}\n", nlohmann::ordered_json({{"devices", list}}).dump(2));
  else if (devices.empty())
    fmt::print("{}\n", Device::none_found());
}

}  // namespace

void DeviceArguments::add_to(CLI::App& command) {
  command
      .add_option_function<std::string>(
          "--device",
          [this, &command](const std::string& name) {
            name_ = name;
            if (name != "list") return;
            const CLI::Option* json = command.get_parent()->get_option_no_throw("--json");
            list_devices(json && json->count() > 0);
            throw CLI::Success();
          },
          "device for averaging, filtering and decoding: cpu; gpu: the first OpenCL GPU; auto: "
          "the first GPU, but cpu for small frames and for methods other than zncc; list: print "
          "the OpenCL devices and exit; or an index or part of a name in this list. OpenCL "
          "devices support only zncc, with the same results as cpu")
      ->default_str(name_)
      ->group(for_experts);
}

std::unique_ptr<FrameBackend> DeviceArguments::backend(
    std::unique_ptr<const DepthDecoder> decoder) const {
  try {
    return frame_backend(name_, std::move(decoder));
  } catch (const std::invalid_argument& error) {
    throw wrong_option(error);
  }
}

}  // namespace tofsmith::apps
