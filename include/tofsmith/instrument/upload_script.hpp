// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tofsmith/instrument/generator_model.hpp"
#include "tofsmith/io/quantized_waveform.hpp"

namespace tofsmith {

/// What one channel of a generator is given.
struct UploadChannel {
  int channel = 1;                        ///< 1, 2
  std::vector<QuantizedWaveform> stored;  ///< tables for its memory, in this order
  int selected = 0;                       ///< index of the one it plays

  /// @throws std::out_of_range if no stored waveform is selected
  const QuantizedWaveform& selected_waveform() const;
};

/// How a Siglent is told the waveform; sources disagree, see docs/instruments.md.
enum class WaveHeader {
  length,   ///< with LENGTH, so that the message says where it ends
  plain,    ///< as Siglent's application note
  minimal,  ///< name and data only
};

/// What a generator is asked to do.
struct UploadRequest {
  std::vector<UploadChannel> channels;
  double load_ohm = 50.0;  ///< that the volts are meant for, 1 .. 1e6, or infinity: high impedance
  bool output_on = false;  ///< at the end; otherwise outputs stay off
  bool read_back = true;   ///< the points; some models cannot
  bool reset = true;       ///< to the generator's defaults first, so that nothing old plays on
  bool true_arb = false;   ///< Siglent: play every point instead of skipping some
  WaveHeader wave_header = WaveHeader::length;  ///< Siglent
  double settle_s = 0.5;                        ///< Siglent: pause behind a waveform, 0 .. 60
  double patience_s = 20.0;     ///< more than usual for a reset and for files, 0 .. 600
  std::string filter = "STEP";  ///< Keysight: STEP, NORM or OFF
};

/// What an answer must say.
struct AnswerCheck {
  int channel = 0;       ///< 0: none
  std::string quantity;  ///< "amplitude_vpp", ..
  std::string field;     ///< key of answers such as "C1:BSWV FRQ,1000HZ,AMP,4V"; empty: all of it
  double wanted = 0.0;   ///< for a number
  double tolerance = 0.0;
  std::vector<std::string> texts;  ///< for a word: any of these, upper case
  bool within = false;             ///< the word may stand anywhere in the answer
};

/// A message to the instrument, and what must come back.
struct UploadStep {
  enum class Answer { none, line, block, wave_data };
  std::string what;     ///< "select the waveform of channel 1"
  std::string message;  ///< without line end
  std::string data;     ///< bytes behind the message
  bool line_end = true;
  bool switches_on = false;  ///< an output
  Answer answer = Answer::none;
  std::vector<AnswerCheck> checks;  ///< of a line
  /// Of a block or wave data: what is wrong with it, or "".
  std::function<std::string(const std::string& bytes)> problem;
  std::size_t expected_bytes = 0, most_bytes = 0;
  double more_s = 0.0;   ///< that an answer may take longer than usual
  double pause_s = 0.0;  ///< behind the message
};

/// Everything said to a generator for one upload, in order.
struct UploadScript {
  GeneratorModel model;
  std::vector<UploadStep> steps;
  std::vector<std::string> outputs_off;          ///< messages that make it safe
  bool reads_back = true;                        ///< points of every waveform are compared
  std::vector<std::string> cannot_be_read_back;  ///< what no answer confirms
};

/// @throws std::invalid_argument naming what does not fit the model: channels, memory, points,
///         rate, frequency, volts
UploadScript upload_script(const GeneratorModel& model, const UploadRequest& request);

/// The messages as text, one a line, data summarized: what would be sent.
std::string script_text(const UploadScript& script);

/// Volts at a load for each volt into 50 ohm.
double load_gain(double load_ohm);

/// What is wrong with an answer, or "". @param value  the number found, if it is one
std::string answer_problem(const AnswerCheck& check, const std::string& answer,
                           double* value = nullptr);

}  // namespace tofsmith
