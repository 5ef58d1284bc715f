// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "core/shared/random.hpp"
#include "simulated_generator.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/instrument/upload.hpp"
#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith {

/// One generator of each family.
struct FamilyExample {
  SimulatedGenerator::Family family;
  const char* answers;  ///< as its model, in the answer to *IDN?
  const char* model;
};
inline constexpr FamilyExample family_examples[] = {
    {SimulatedGenerator::Family::siglent, "SDG2042X", "SDG2042X"},
    {SimulatedGenerator::Family::keysight, "33522B", "33522"},
    {SimulatedGenerator::Family::tektronix, "AFG3022C", "AFG3022"}};

/// A connection without network and without clock: what does not answer at once never does.
class MemoryConnection : public InstrumentConnection {
 public:
  explicit MemoryConnection(SimulatedGenerator& generator, bool splits = false)
      : generator_(generator), splits_(splits) {}
  void send(std::string_view message, double) override {
    if (generator_.closed()) throw IoError(name(), "the connection broke");
    answers_ += generator_.take(message);
  }
  std::string receive(double) override {
    if (answers_.empty() && generator_.closed()) throw IoError(name(), "the connection is closed");
    const std::string piece = answers_.substr(0, splits_ ? 1 : answers_.size());
    answers_.erase(0, piece.size());
    return piece;
  }
  std::string name() const override { return "tcp://simulated:5025"; }

 private:
  SimulatedGenerator& generator_;
  bool splits_;
  std::string answers_;
};

inline QuantizedWaveform random_waveform(const GeneratorModel& model, Arm arm, int index,
                                         int points = 48) {
  QuantizedWaveform waveform;
  waveform.name = (arm == Arm::light ? "modulation_" : "demodulation_") + std::to_string(index + 1);
  waveform.arm = arm;
  waveform.index = index;
  waveform.levels = waveform_format(model.format()).levels;
  RandomStream random(17, static_cast<std::uint64_t>(index), arm == Arm::light ? 0 : 1);
  for (int i = 0; i < points; ++i)
    waveform.codes.push_back(
        static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(waveform.levels)));
  waveform.sample_rate_hz = 123456.7 * points;
  waveform.low_v = arm == Arm::light ? 0.0 : -0.25;
  waveform.high_v = arm == Arm::light ? 1.5 : 0.75;
  return waveform;
}

/// Light on channel 1 and sensor on channel 2, two exposures in memory, the second selected.
inline UploadRequest example_request(const GeneratorModel& model, int points = 48) {
  UploadRequest request;
  request.settle_s = 0.0;
  request.patience_s = 0.0;
  for (const Arm arm : {Arm::light, Arm::sensor})
    request.channels.push_back(
        {arm == Arm::light ? 1 : 2,
         {random_waveform(model, arm, 0, points), random_waveform(model, arm, 1, points)},
         1});
  return request;
}

/// Whether the generator plays what was asked for.
inline bool plays(const SimulatedGenerator& generator, const UploadRequest& request,
                  const GeneratorModel& model) {
  const auto near = [](double a, double b, double tolerance) {
    return std::abs(a - b) <= tolerance;
  };
  for (const UploadChannel& wanted : request.channels) {
    const QuantizedWaveform& w = wanted.selected_waveform();
    const SimulatedGenerator::Channel& c = generator.channel(wanted.channel);
    const bool by_rate = model.family == GeneratorFamily::keysight_trueform;
    const double requested_hz = by_rate ? w.sample_rate_hz : w.repetition_hz(),
                 set_hz = by_rate ? c.sample_rate_hz : c.frequency_hz;
    if (generator.played_codes(wanted.channel) != w.codes || c.on != request.output_on ||
        !near(c.amplitude_vpp, w.amplitude_vpp(), 2e-3) || !near(c.offset_v, w.offset_v(), 2e-3) ||
        !near(set_hz, requested_hz, 2e-5 * requested_hz) ||
        !near(c.load_ohm, request.load_ohm, 1.0) || !near(c.phase, 0.0, 0.02))
      return false;
  }
  return model.family != GeneratorFamily::siglent_x || generator.phases_locked();
}

inline UploadReport upload_to(SimulatedGenerator& generator, const UploadScript& script,
                              bool splits = false, const Progress& progress = {}) {
  ScpiSession session(std::make_unique<MemoryConnection>(generator, splits), 1.0);
  identified_model(identify(session), session.name());
  return upload(session, script, progress);
}

/// What a function throws, or "".
template <typename Function>
std::string problem_of(Function function) {
  try {
    function();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace tofsmith
