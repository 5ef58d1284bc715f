// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The only file that sees Boost.Asio.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <optional>

#include "instrument/vxi11_connection.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/instrument/scpi_session.hpp"

namespace tofsmith {

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t chunk_bytes = 65536;
constexpr double slice_s = 0.05;  // how soon a wait can be stopped

SteadyClock::duration in_seconds(double seconds) {
  return std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(seconds));
}

class TcpConnection : public InstrumentConnection {
 public:
  TcpConnection(const InstrumentAddress& address, double deadline_s, const StopCheck& check_stop)
      : name_(address.text()), socket_(io_) {
    const tcp::resolver::results_type places = resolved(address);
    std::optional<error_code> result;
    asio::async_connect(socket_, places,
                        [&](error_code error, const tcp::endpoint&) { result = error; });
    const auto end = SteadyClock::now() + in_seconds(deadline_s);
    try {
      while (!result && SteadyClock::now() < end) {
        run_for(std::min(slice_s, deadline_s));
        if (!result && check_stop) check_stop();
      }
    } catch (...) {
      stop();  // the handler refers to what is going away
      throw;
    }
    if (!result) {
      stop();
      throw IoError(name_, fmt::format("no answer within {:g} s; check that the instrument is on, "
                                       "in this network and not blocked by a firewall",
                                       deadline_s));
    }
    if (*result)
      throw IoError(name_, fmt::format("cannot connect ({}); check the address and that no other "
                                       "program uses the instrument (raw SCPI is at port 5025 of "
                                       "Siglent and Keysight, 4000 of Tektronix)",
                                       result->message()));
    socket_.set_option(tcp::no_delay(true));
  }

  void send(std::string_view message, double deadline_s) override {
    const auto end = SteadyClock::now() + in_seconds(deadline_s);
    std::size_t sent = 0;
    while (sent < message.size()) {
      const std::string_view chunk = message.substr(sent, chunk_bytes);
      std::optional<error_code> result;
      std::size_t count = 0;
      socket_.async_write_some(asio::buffer(chunk.data(), chunk.size()),
                               [&](error_code error, std::size_t bytes) {
                                 result = error;
                                 count = bytes;
                               });
      wait_until(end, result);
      sent += count;
      if (*result == asio::error::operation_aborted && count == 0)
        throw IoError(name_,
                      fmt::format("it took {} of {} bytes within {:g} s; it hangs: switch it "
                                  "off and on, and try again",
                                  sent, message.size(), deadline_s));
      if (*result && *result != asio::error::operation_aborted)
        throw IoError(name_,
                      fmt::format("the connection broke ({}) after {} of {} bytes; check the "
                                  "instrument and try again",
                                  result->message(), sent, message.size()));
    }
  }

  std::string receive(double deadline_s) override {
    std::optional<error_code> result;
    std::size_t count = 0;
    socket_.async_read_some(asio::buffer(buffer_), [&](error_code error, std::size_t bytes) {
      result = error;
      count = bytes;
    });
    wait_until(SteadyClock::now() + in_seconds(deadline_s), result);
    if (count == 0 && *result != asio::error::operation_aborted)
      throw IoError(name_, fmt::format("the instrument closed the connection ({}); is another "
                                       "program using it?",
                                       result->message()));
    return {buffer_.data(), count};
  }

  std::string name() const override { return name_; }

 private:
  void run_for(double seconds) {
    io_.restart();
    io_.run_for(in_seconds(seconds));
  }

  /// Waits for an operation; aborts it when the time is over. Then there is a result.
  void wait_until(SteadyClock::time_point end, std::optional<error_code>& result) {
    io_.restart();
    io_.run_until(end);
    if (result) return;
    error_code ignored;
    socket_.cancel(ignored);
    io_.restart();
    io_.run();
  }

  void stop() {
    error_code ignored;
    socket_.close(ignored);
    io_.restart();
    io_.run();
  }

  /// A number needs no look-up; the time of one for a name is the system's.
  tcp::resolver::results_type resolved(const InstrumentAddress& address) {
    error_code error;
    const auto number = asio::ip::make_address(address.host, error);
    const std::string port = std::to_string(address.port);
    if (!error)
      return tcp::resolver::results_type::create(
          tcp::endpoint(number, static_cast<unsigned short>(address.port)), address.host, port);
    auto places = tcp::resolver(io_).resolve(address.host, port, error);
    if (error)
      throw IoError(name_, fmt::format("there is no host '{}' ({}); check its name, or give its "
                                       "number",
                                       address.host, error.message()));
    return places;
  }

  std::string name_;
  asio::io_context io_;
  tcp::socket socket_;
  std::array<char, chunk_bytes> buffer_{};
};

}  // namespace

std::unique_ptr<InstrumentConnection> connect_instrument(const InstrumentAddress& address,
                                                         double deadline_s,
                                                         const StopCheck& check_stop) {
  if (address.protocol == InstrumentAddress::Protocol::vxi11)
    return connect_vxi11(address, deadline_s);
  return std::make_unique<TcpConnection>(address, deadline_s, check_stop);
}

}  // namespace tofsmith
