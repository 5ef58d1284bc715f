// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// What goes wrong, once, in a simulated generator.
enum class Fault {
  none,
  closes,            ///< the connection, instead of taking a message
  closes_midway,     ///< the connection, when it has taken half of some bytes
  closes_answering,  ///< the connection, in the middle of an answer
  hangs,             ///< takes and answers nothing any more
  ignores,           ///< a message
  reports_error,     ///< and does not do what a message says
  answers_garbage,
  flips_answer_bit,
  flips_bit_sent,    ///< to it
  loses_byte_sent,   ///< to it
  wrong_length,      ///< of a block it answers
  corrupts_point,    ///< that it stores
  truncates_points,  ///< that it stores
  other_value,       ///< of a setting
  other_memory,      ///< takes points for another channel, or another name
  extra_line,
  repeats_answer,
  swallows_answer,
  splits_answer,  ///< into single bytes: right, only slow
};
inline constexpr int fault_kinds = static_cast<int>(Fault::splits_answer) + 1;

/// A generator in a few hundred lines: takes bytes, answers bytes, keeps points and settings. It
/// understands what an upload sends to three families, from their manuals and not from the code
/// under test.
class SimulatedGenerator {
 public:
  enum class Family { siglent, keysight, tektronix };
  struct Channel {
    bool on = false, phase_zero = false;
    double frequency_hz = 1000.0, sample_rate_hz = 40e3, amplitude_vpp = 4.0, offset_v = 0.5;
    double load_ohm = 1e6, phase = 0.0;
    std::string function = "SIN", waveform, filter = "NORM", clock = "DDS";
  };

  /// @param model  as it stands in the answer to *IDN?
  SimulatedGenerator(Family family, const std::string& model);

  /// From now on: what goes wrong, at which message, and a number that says how exactly.
  void set_fault(Fault fault, int message, std::uint32_t detail);

  /// Takes bytes of a connection; gives the answers.
  std::string take(std::string_view bytes);
  bool closed() const { return closed_; }
  /// A new connection: what is left of an unfinished message is gone, as is a closed connection.
  void reconnect();

  const Channel& channel(int number) const { return channels_.at(number - 1); }
  /// Points that a channel plays, as unsigned codes of its family; empty if it plays something
  /// else.
  std::vector<std::int32_t> played_codes(int number) const;
  bool phases_locked() const { return phases_locked_; }
  int messages() const { return messages_; }
  int waveforms() const { return static_cast<int>(memory_.size()); }

 private:
  bool strikes(Fault fault);
  bool next_message(std::string& message);
  std::string answer(const std::string& message);
  std::string spoiled(std::string answer);
  std::string obey(const std::string& message);
  std::string obey_siglent(const std::string& message);
  std::string obey_keysight(const std::string& message);
  std::string obey_tektronix(const std::string& message);
  std::string wave_data(const std::string& name) const;
  void store(std::string name, std::string points);
  double setting(std::string_view text);
  void reset();

  Family family_;
  std::string model_;
  std::array<Channel, 2> channels_;
  std::map<std::string, std::string> memory_, files_;  // points as they were sent
  std::string edit_memory_;
  std::vector<std::string> errors_;
  bool phases_locked_ = false;

  Fault fault_ = Fault::none;
  int fault_message_ = 0;
  std::uint32_t detail_ = 0;
  std::string received_;
  int messages_ = 0;
  bool closed_ = false, hangs_ = false;
};

}  // namespace tofsmith
