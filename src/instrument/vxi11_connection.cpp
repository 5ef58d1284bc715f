// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "instrument/vxi11_connection.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tofsmith/core/error.hpp"
#include "tofsmith/instrument/scpi_session.hpp"

#ifdef TOFSMITH_HAS_LXI
#include <csignal>
extern "C" {
#include <lxi.h>
}
#endif

namespace tofsmith {

#ifdef TOFSMITH_HAS_LXI

namespace {

constexpr double min_wait_s = 1.0;

int milliseconds(double seconds) { return static_cast<int>(seconds * 1e3) + 1; }

/// liblxi writes to a socket whose peer may be gone, and the signal would end the process.
class WithoutBrokenPipeSignal {
 public:
  WithoutBrokenPipeSignal() : before_(std::signal(SIGPIPE, SIG_IGN)) {}
  ~WithoutBrokenPipeSignal() { std::signal(SIGPIPE, before_); }
  WithoutBrokenPipeSignal(const WithoutBrokenPipeSignal&) = delete;
  WithoutBrokenPipeSignal& operator=(const WithoutBrokenPipeSignal&) = delete;

 private:
  void (*before_)(int);
};

/// Whether something listens where VXI-11 asks for its service first. liblxi must not be asked
/// where nothing does: it may wait for its own thread for ever when that gives up just at the
/// deadline.
bool port_mapper_answers(const std::string& host, double deadline_s) {
  constexpr int port_mapper = 111;
  try {
    connect_instrument({InstrumentAddress::Protocol::raw_socket, host, port_mapper}, deadline_s);
    return true;
  } catch (const IoError&) {
    return false;
  }
}

class Vxi11Connection : public InstrumentConnection {
 public:
  Vxi11Connection(const InstrumentAddress& address, double deadline_s) : name_(address.text()) {
    lxi_init();
    const WithoutBrokenPipeSignal guard;
    if (port_mapper_answers(address.host, deadline_s))
      device_ = lxi_connect(address.host.c_str(), 0, nullptr, milliseconds(deadline_s), VXI11);
    if (device_ < 0)
      throw IoError(name_, fmt::format("no instrument answers VXI-11 within {:g} s; check its "
                                       "address and that its VXI-11 (LXI) service is on",
                                       deadline_s));
  }
  ~Vxi11Connection() override {
    const WithoutBrokenPipeSignal guard;
    lxi_disconnect(device_);
  }
  Vxi11Connection(const Vxi11Connection&) = delete;
  Vxi11Connection& operator=(const Vxi11Connection&) = delete;

  void send(std::string_view message, double deadline_s) override {
    if (message.size() > max_vxi11_bytes)
      throw IoError(name_,
                    fmt::format("a message of {} bytes is too long for VXI-11 here; expected "
                                "at most {}: use the raw socket (tcp://) or fewer points",
                                message.size(), max_vxi11_bytes));
    const WithoutBrokenPipeSignal guard;
    const int sent = lxi_send(device_, message.data(), static_cast<int>(message.size()),
                              milliseconds(deadline_s));
    if (sent != static_cast<int>(message.size()))
      throw IoError(name_, fmt::format("it took {} of {} bytes; is it an instrument, and on?",
                                       sent < 0 ? 0 : sent, message.size()));
  }

  std::string receive(double deadline_s) override {
    if (deadline_s <= 0.0) return "";  // asking for what was not asked for is an error there
    std::string bytes(65536, '\0');
    const WithoutBrokenPipeSignal guard;
    const int got = lxi_receive(device_, bytes.data(), static_cast<int>(bytes.size()),
                                milliseconds(std::max(deadline_s, min_wait_s)));
    bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return bytes;
  }

  std::string name() const override { return name_; }

 private:
  std::string name_;
  int device_ = -1;
};

}  // namespace

bool has_vxi11() { return true; }

std::unique_ptr<InstrumentConnection> connect_vxi11(const InstrumentAddress& address,
                                                    double deadline_s) {
  return std::make_unique<Vxi11Connection>(address, deadline_s);
}

#else

bool has_vxi11() { return false; }

std::unique_ptr<InstrumentConnection> connect_vxi11(const InstrumentAddress& address,
                                                    double /*deadline_s*/) {
  throw IoError(address.text(),
                "this tofsmith was built without VXI-11; use the raw socket (tcp://host:port), or "
                "build it where liblxi-dev is installed");
}

#endif

}  // namespace tofsmith
