// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "tofsmith/instrument/instrument_connection.hpp"

namespace tofsmith {

/// Messages to an instrument and its answers, framed as IEEE 488.2 says. Every error names the
/// instrument, what was sent, what came and what to do next.
class ScpiSession {
 public:
  /// @param answer_s    longest wait for an answer [s]
  /// @param check_stop  called while an answer is waited for; may throw
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
  /// @param most_bytes  longer ones are refused
  std::string read_block(std::size_t most_bytes, double more_s = 0.0);
  /// A generator's answer to WVDT?: a header, "WAVEDATA,", and as many bytes as its LENGTH says, or
  /// `expected_bytes` if it has none.
  std::string read_wave_data(std::size_t expected_bytes, std::size_t most_bytes);

  /// @throws IoError if something came that was not asked for
  void expect_silence();

  std::string name() const { return connection_->name(); }

 private:
  /// Waits until there are so many bytes. @throws IoError naming what is missing
  void fill(std::size_t bytes, std::string_view what, double more_s = 0.0);
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
