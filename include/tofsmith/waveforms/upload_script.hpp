// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith {

/// Waveforms for one channel of a generator.
struct UploadChannel {
  int channel = 1;
  std::vector<QuantizedWaveform> stored;
  int selected = 0;  ///< table to output

  /// @throws std::out_of_range if none is selected
  const QuantizedWaveform& selected_waveform() const;
};

/// Header of a waveform for a Siglent generator, see docs/instruments.md.
enum class WaveHeader {
  length,   ///< with LENGTH
  plain,    ///< as in Siglent's application note
  minimal,  ///< name and data only
};
constexpr auto words_of(WaveHeader /*any*/) { return word_list("length", "plain", "minimal"); }

/// Filter of the output of a Keysight generator.
enum class OutputFilter { step, normal, off };
constexpr auto words_of(OutputFilter /*any*/) { return word_list("step", "normal", "off"); }

struct UploadRequest {
  std::vector<UploadChannel> channels;
  double load_ohm = 50.0;
  bool output_on = false;
  bool read_back = true;
  bool reset = true;
  bool true_arb = false;
  WaveHeader wave_header = WaveHeader::length;
  double settle_s = 0.5;
  double patience_s = 20.0;
  OutputFilter filter = OutputFilter::step;
};
auto fields_of(ConstOrNot<UploadRequest> auto& r) {
  constexpr OnlyWith siglent{"a Siglent"}, keysight{"a Keysight"};
  return std::tuple(
      Field("channels", r.channels, FieldMark::from_above),
      Field("load_ohm", r.load_ohm,
            Help{"load that the voltages refer to: 1 to 1e6, or inf for an open circuit"}),
      Field("output_on", r.output_on, Help{"switch the outputs on after verification"}),
      Field(
          "read_back", r.read_back,
          Help{"verify the points by reading them back; some models do not support reading back"}),
      Field("reset", r.reset,
            Help{"reset the instrument first; without a reset, earlier settings could change the "
                 "output"}),
      Field("true_arb", r.true_arb, Help{"output every point instead of skipping some"}, siglent),
      Field("wave_header", r.wave_header,
            Help{"form of the header of a waveform; published descriptions of it differ"}, siglent),
      Field("settle_s", r.settle_s, closed(0, 60), Help{"pause after a waveform"}, siglent),
      Field("patience_s", r.patience_s, closed(0, 600),
            Help{"additional time for a reset and for files"}),
      Field("filter", r.filter, Help{"output filter"}, keysight));
}

/// Expected content of an answer.
struct AnswerCheck {
  int channel = 0;       ///< 0: none
  std::string quantity;  ///< "amplitude_vpp", ...
  std::string field;     ///< key in "C1:BSWV FRQ,1000HZ,AMP,4V"; empty: the whole answer
  double wanted = 0.0;
  double tolerance = 0.0;
  std::vector<std::string> texts;  ///< any of these, upper case
  bool within = false;             ///< the word may be part of the answer
};

/// A message to the instrument and the required answer.
struct UploadStep {
  enum class Answer {
    none,
    line,       ///< text that passes `checks`
    block,      ///< the bytes `expected`
    arb_file,   ///< an .arb file with the numbers in `expected` as points
    wave_data,  ///< a header that passes `checks`, "WAVEDATA,", then the bytes `expected`
  };
  std::string what;     ///< "select the waveform of channel 1"
  std::string message;  ///< without end of line
  std::string data;
  bool line_end = true;
  bool switches_on = false;  ///< of an output
  Answer answer = Answer::none;
  std::vector<AnswerCheck> checks;
  std::string expected;
  double more_s = 0.0;   ///< for the answer
  double pause_s = 0.0;  ///< after the message
};

struct UploadScript {
  GeneratorModel model;
  std::vector<UploadChannel> channels;
  std::vector<UploadStep> steps;
  std::vector<std::string> outputs_off;          ///< messages that switch to a safe state
  bool reads_back = true;                        ///< points are compared
  std::vector<std::string> cannot_be_read_back;  ///< settings that no answer confirms
};

/// Returns the messages of an upload.
/// @throws std::invalid_argument naming what does not fit the model
UploadScript upload_script(const GeneratorModel& model, const UploadRequest& request);

/// Returns the messages as lines; data is shown as a number of bytes.
std::string script_text(const UploadScript& script);

/// Voltage at a load per volt into 50 ohm.
double load_gain(double load_ohm);

/// Exposures to load, and the exposure to output.
struct UploadSelection {
  int light_channel = 1;
  int sensor_channel = 2;
  int exposure = 1;
  int tap = 1;
  bool all = false;

  /// @throws std::invalid_argument
  void validate() const;
};
auto fields_of(ConstOrNot<UploadSelection> auto& s) {
  return std::tuple(
      Field("light_channel", s.light_channel, closed(0, 8), Help{"channel for the light; 0: none"}),
      Field("sensor_channel", s.sensor_channel, closed(0, 8),
            Help{"channel for the sensor's gain; 0: none"}),
      Field("exposure", s.exposure, at_least(1),
            Help{"number of the exposure to output; the first is 1"}),
      Field("tap", s.tap, at_least(1),
            Help{"number of the tap for the sensor's channel; the first is 1"}),
      Field("all", s.all, Help{"load all exposures; only the selected exposure is output"}));
}

/// Converts a code to tables for a model. The default sample rate is the highest, with `true_arb`
/// the highest without skipped points.
/// @throws std::invalid_argument naming the option that breaks a rule of the format or the model
WaveformExport export_for_model(const CodeSet& code, const Camera& camera,
                                const GeneratorModel& model, ExportOptions options, bool true_arb);

/// Returns the channels of a selection.
/// @throws std::invalid_argument if the code has no such exposure or tap
std::vector<UploadChannel> selected_channels(const WaveformExport& exported,
                                             const UploadSelection& selection);

/// A script for one exposure and all models that accept the same messages.
struct ExportedScript {
  std::string name;  ///< "SDG2042X_exposure_1.scpi.txt", after the first model
  std::string text;
};

struct ExportedScripts {
  std::vector<ExportedScript> files;
  std::string problem;  ///< reason why files of a generator have no script; of the fastest model
};

/// Returns scripts for each exposure of a code on two-channel generators with the format of the
/// tables: light on channel 1, first tap on channel 2, outputs off. Models with equal scripts share
/// one.
ExportedScripts export_scripts(const WaveformExport& exported);

}  // namespace tofsmith
