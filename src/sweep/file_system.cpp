// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/file_system.hpp"

#include <sys/statfs.h>

#include <array>
#include <utility>

namespace tofsmith {

namespace {

/// From linux/magic.h and the sources of the file systems.
constexpr std::array<std::pair<std::uint32_t, const char*>, 18> network_file_systems = {{
    {0x6969, "NFS"},
    {0x517b, "SMB"},
    {0xff534d42, "CIFS"},
    {0xfe534d42, "SMB2"},
    {0x0bd00bd0, "Lustre"},
    {0x65735546, "FUSE"},
    {0x47504653, "GPFS"},
    {0x00c36400, "Ceph"},
    {0x5346414f, "AFS"},
    {0x6b414653, "kAFS"},
    {0x01021997, "9P"},
    {0x7461636f, "OCFS2"},
    {0x01161970, "GFS2"},
    {0x19830326, "BeeGFS"},
    {0xaad7aaea, "PanFS"},
    {0x73757245, "Coda"},
    {0x564c, "NCP"},
    {0x20030528, "OrangeFS"},
}};

}  // namespace

std::string network_file_system(std::uint32_t magic) {
  for (const auto& [number, name] : network_file_systems)
    if (number == magic) return name;
  return "";
}

std::string network_file_system_at(const std::filesystem::path& path) {
  struct statfs found {};
  const std::filesystem::path absolute = std::filesystem::absolute(path);
  if (::statfs(absolute.c_str(), &found) != 0 &&
      ::statfs(absolute.parent_path().c_str(), &found) != 0)
    return "";
  return network_file_system(static_cast<std::uint32_t>(found.f_type));
}

}  // namespace tofsmith
