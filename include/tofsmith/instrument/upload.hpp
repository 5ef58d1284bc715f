// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/instrument/scpi_session.hpp"
#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith {

/// What an instrument says of itself.
struct InstrumentIdentity {
  std::string vendor, model, serial, firmware;
};

/// Reads an answer to *IDN?. @throws IoError "place: .." if it is none
InstrumentIdentity parse_identity(std::string_view answer, std::string_view place);
/// @throws IoError "place: .." for an instrument that is none of the models
const GeneratorModel& identified_model(const InstrumentIdentity& identity, std::string_view place);

/// What one channel of a generator is given.
struct UploadChannel {
  int channel = 1;                        ///< 1, 2
  std::vector<QuantizedWaveform> stored;  ///< tables for its memory, in this order
  int selected = 0;                       ///< index of the one it plays

  /// @throws std::out_of_range if no stored waveform is selected
  const QuantizedWaveform& selected_waveform() const;
};

/// How a waveform is announced to a Siglent; sources disagree, see docs/instruments.md.
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
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<UploadRequest> auto& r) {
  return std::tuple(Field("channels", r.channels, FieldMark::from_above),
                    Field("load_ohm", r.load_ohm), Field("output_on", r.output_on),
                    Field("read_back", r.read_back), Field("reset", r.reset),
                    Field("true_arb", r.true_arb), Field("wave_header", r.wave_header),
                    Field("settle_s", r.settle_s, closed(0, 60)),
                    Field("patience_s", r.patience_s, closed(0, 600)), Field("filter", r.filter));
}

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
  std::size_t expected_bytes = 0, max_bytes = 0;
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

/// What of a code a generator is given.
struct UploadSelection {
  int light_channel = 1;   ///< that plays the light; 0: none
  int sensor_channel = 2;  ///< that plays the sensor's gain; 0: none
  int exposure = 1;        ///< which of the pairs is played, from 1
  int tap = 1;             ///< that the sensor's channel plays, from 1
  bool all = false;        ///< load all pairs

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<UploadSelection> auto& s) {
  return std::tuple(Field("light_channel", s.light_channel, at_least(0)),
                    Field("sensor_channel", s.sensor_channel, at_least(0)),
                    Field("exposure", s.exposure, at_least(1)), Field("tap", s.tap, at_least(1)),
                    Field("all", s.all));
}

/// A code as tables for a model: of its format and, unless the options say another, its highest
/// rate (with `true_arb`: that at which every point is played).
/// @throws std::invalid_argument naming the option that breaks a rule of the format or the model
WaveformExport export_for_model(const CodeSet& code, const Camera& camera,
                                const GeneratorModel& model, ExportOptions options, bool true_arb);

/// The channels of that selection, each with the tables that it holds and the one that it plays.
/// @throws std::invalid_argument if the code has no such exposure or tap
std::vector<UploadChannel> selected_channels(const WaveformExport& exported,
                                             const UploadSelection& selection);

/// "step", "normal" or "off" as in a Keysight's command. @throws std::invalid_argument
std::string parse_output_filter(std::string_view word);
/// "length", "plain" or "minimal". @throws std::invalid_argument for any other word
WaveHeader parse_wave_header(std::string_view word);

/// A step that went well.
struct UploadedStep {
  std::string what, sent, answer;  ///< answer: "" for none, large ones summarized
};

/// A number that the instrument reads back, beside the one requested.
struct ReadBackNumber {
  int channel = 0;  ///< 0: none
  std::string quantity;
  double requested = 0.0, read_back = 0.0;
};

/// What an upload did.
struct UploadReport {
  bool verified = false;  ///< all points and all settings were read back and are as requested
  std::string message;    ///< one line, with what could not be read back
  std::vector<UploadedStep> steps;
  std::vector<ReadBackNumber> numbers;
};

/// Asks the instrument who it is. @throws IoError if that is no answer to *IDN?
InstrumentIdentity identify(ScpiSession& session);

/// Says a script to an instrument, step by step: waits for every answer, asks for errors behind
/// every message, and compares what is read back. After a failure, or when `progress` stops it,
/// outputs are switched off as well as that still goes.
/// @throws IoError naming the instrument, the step, what was sent, what came and what was expected
/// @throws Interrupted
UploadReport upload(ScpiSession& session, const UploadScript& script,
                    const Progress& progress = {});

}  // namespace tofsmith
