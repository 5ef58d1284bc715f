// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tofsmith {

/// Where an instrument is in the network.
struct InstrumentAddress {
  enum class Protocol {
    raw_socket,  ///< SCPI over TCP
    vxi11,       ///< where the library was built with liblxi
  };
  Protocol protocol = Protocol::raw_socket;
  std::string host;  ///< name or number
  int port = 5025;   ///< of a raw socket

  /// "tcp://host:5025", "vxi11://host"
  std::string text() const;

  friend bool operator==(const InstrumentAddress&, const InstrumentAddress&) = default;
};

/// Reads host, host:port, [IPv6]:port, tcp://host:port, vxi11://host, TCPIP::host::port::SOCKET and
/// TCPIP::host::INSTR (VXI-11). Without a port it is 5025.
/// @throws std::invalid_argument naming what is wrong for anything else
InstrumentAddress parse_instrument_address(std::string_view text);

}  // namespace tofsmith
