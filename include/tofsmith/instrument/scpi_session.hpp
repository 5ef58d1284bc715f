// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
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

/// Messages to an instrument and its answers, framed as IEEE 488.2 says. Every error names the
/// instrument, what was sent, what came and what to do next.
class ScpiSession {
 public:
  /// @param answer_s    longest wait for a whole answer [s]; blocks of data have a second more for
  ///                    each 100 kB
  /// @param check_stop  called while an answer is waited for, and with each piece of it; may throw
  ScpiSession(std::unique_ptr<InstrumentConnection> connection, double answer_s,
              StopCheck check_stop = {});

  /// Sends a message as it is. Large ones have more time, a second for each 100 kB.
  /// @throws IoError if something came that was not asked for, or the bytes are not taken in time
  void send(std::string_view message);
  /// The same whatever has come: a last message before the connection ends.
  void send_regardless(std::string_view message);

  /// A line without its end. @throws IoError if none comes in time
  std::string read_line(double more_s = 0.0);
  /// The data of a definite-length block.
  /// @param max_bytes  longer ones are refused
  std::string read_block(std::size_t max_bytes, double more_s = 0.0);
  /// A generator's answer to WVDT?: a header, "WAVEDATA,", and as many bytes as its LENGTH says, or
  /// `expected_bytes` if it has none.
  std::string read_wave_data(std::size_t expected_bytes, std::size_t max_bytes);

  /// @throws IoError if something came that was not asked for
  void expect_silence();

  std::string name() const { return connection_->name(); }

 private:
  class AnswerTime;

  /// Waits until there are so many bytes. @throws IoError naming what is missing
  void fill(std::size_t bytes, std::string_view what, const AnswerTime& time);
  /// One more piece, or none in time.
  bool receive_more(double seconds);
  void skip_line_ends();
  std::string take(std::size_t bytes);
  [[noreturn]] void fail(std::string_view problem) const;

  std::unique_ptr<InstrumentConnection> connection_;
  double answer_s_;
  StopCheck check_stop_;
  std::string received_;
  std::string last_sent_;
};

/// Bytes as they can be printed: at most `most` characters, others than ASCII as `\xNN`.
std::string printable(std::string_view bytes, std::size_t most = 60);

}  // namespace tofsmith
