// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "tofsmith/instrument/instrument_address.hpp"

namespace tofsmith {

/// Carries bytes to an instrument and back. Every operation ends by its deadline.
class InstrumentConnection {
 public:
  InstrumentConnection() = default;
  InstrumentConnection(const InstrumentConnection&) = delete;
  InstrumentConnection& operator=(const InstrumentConnection&) = delete;
  virtual ~InstrumentConnection() = default;

  /// Sends a whole message.
  /// @throws IoError naming the instrument if it does not take all bytes in time
  virtual void send(std::string_view message, double deadline_s) = 0;
  /// Waits for bytes: at least one, or none when the time is over.
  /// @throws IoError naming the instrument if it has closed the connection
  virtual std::string receive(double deadline_s) = 0;
  /// What errors call the instrument.
  virtual std::string name() const = 0;
};

/// Called while something is waited for; it may throw to stop that.
using StopCheck = std::function<void()>;

/// @throws IoError naming host and port if nothing answers there by the deadline, or for VXI-11 in
///         a library without it
std::unique_ptr<InstrumentConnection> connect_instrument(const InstrumentAddress& address,
                                                         double deadline_s,
                                                         const StopCheck& check_stop = {});

/// Whether the library was built with VXI-11.
bool has_vxi11();

}  // namespace tofsmith
