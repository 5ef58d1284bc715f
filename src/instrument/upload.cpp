// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/instrument/upload.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr int max_old_errors = 64;

/// "0,\"No error\"", "+0,..", "-222,\"Data out of range\""
bool is_no_error(const std::string& answer) {
  const std::size_t digits = answer.starts_with('+') || answer.starts_with('-') ? 1 : 0;
  return answer.size() > digits && answer.substr(digits, 2) == "0,";
}

class Uploader {
 public:
  Uploader(ScpiSession& session, const UploadScript& script, const Progress& progress)
      : session_(session), script_(script), progress_(progress) {}

  UploadReport run() {
    forget_old_errors();
    double done = 0.0;
    for (const UploadStep& step : script_.steps) {
      tofsmith::report(progress_, done / static_cast<double>(script_.steps.size()), step.what);
      say(step);
      done += 1.0;
    }
    session_.expect_silence();
    report_.verified = script_.reads_back;
    report_.message = message();
    tofsmith::report(progress_, 1.0, "done");
    return std::move(report_);
  }

  /// As well as it still goes.
  void switch_outputs_off() noexcept {
    try {
      for (const std::string& message : script_.outputs_off)
        session_.send_regardless(message + "\n");
    } catch (...) {
      unsafe_ = true;
    }
  }
  bool is_unsafe() const { return unsafe_ && output_touched_; }

 private:
  [[noreturn]] void fail(const UploadStep& step, std::string_view problem) const {
    throw IoError(session_.name(),
                  fmt::format("{}: sent '{}': {}", step.what, step.message, problem));
  }

  void forget_old_errors() {
    session_.send("*CLS\n");
    if (!script_.model.has_error_queue()) return;
    for (int i = 0; i < max_old_errors; ++i) {
      session_.send("SYST:ERR?\n");
      if (is_no_error(session_.read_line())) return;
    }
    throw IoError(session_.name(), "its list of errors does not end; switch it off and on");
  }

  void say(const UploadStep& step) {
    output_touched_ = output_touched_ || step.switches_on;
    session_.send(step.message + step.data + (step.line_end ? "\n" : ""));
    if (step.pause_s > 0.0)
      std::this_thread::sleep_for(std::chrono::duration<double>(step.pause_s));
    std::string sent = step.message;
    if (!step.data.empty()) sent += fmt::format("<{} bytes>", step.data.size());
    report_.steps.push_back({step.what, std::move(sent), ""});
    switch (step.answer) {
      case UploadStep::Answer::none:
        check_errors(step);
        break;
      case UploadStep::Answer::line:
        check_line(step, session_.read_line(step.more_s));
        break;
      case UploadStep::Answer::block:
        check_data(step, session_.read_block(step.max_bytes, step.more_s));
        break;
      case UploadStep::Answer::wave_data:
        check_data(step, session_.read_wave_data(step.expected_bytes, step.max_bytes));
        break;
    }
  }

  void check_errors(const UploadStep& step) {
    if (!script_.model.has_error_queue()) return;
    session_.send("SYST:ERR?\n");
    const std::string answer = session_.read_line(step.more_s);
    if (!is_no_error(answer))
      fail(step, fmt::format("the instrument reports the error {}", printable(answer, 200)));
  }

  void check_line(const UploadStep& step, const std::string& answer) {
    report_.steps.back().answer = printable(answer, 200);
    for (const AnswerCheck& check : step.checks) {
      double value = 0.0;
      const std::string problem = answer_problem(check, answer, &value);
      if (!problem.empty()) fail(step, problem);
      if (check.texts.empty() && !check.quantity.empty())
        report_.numbers.push_back({check.channel, check.quantity, check.wanted, value});
    }
  }

  void check_data(const UploadStep& step, const std::string& bytes) {
    report_.steps.back().answer = fmt::format("<{} bytes>", bytes.size());
    std::string problem;
    try {
      problem = step.problem(bytes);
    } catch (const IoError& error) {
      problem = error.what();
    }
    if (!problem.empty())
      fail(step, fmt::format("the waveform in the instrument is not the one sent: {}. Nothing is "
                             "played; try again (--no-read-back skips this check)",
                             problem));
  }

  std::string message() const {
    std::string text = script_.reads_back ? "all points and settings read back and equal"
                                          : "unverified: settings read back and equal, points not "
                                            "read back";
    if (!script_.cannot_be_read_back.empty())
      text += fmt::format("; nothing confirms {}", fmt::join(script_.cannot_be_read_back, ", "));
    return text;
  }

  ScpiSession& session_;
  const UploadScript& script_;
  const Progress& progress_;
  UploadReport report_;
  bool output_touched_ = false, unsafe_ = false;
};

}  // namespace

InstrumentIdentity parse_identity(std::string_view answer, std::string_view place) {
  if (answer.starts_with("*IDN ")) answer.remove_prefix(5);
  std::vector<std::string> fields(1);
  for (const char c : answer) {
    if (c == ',')
      fields.emplace_back();
    else if (c != ' ' || !fields.back().empty())
      fields.back() += c;
  }
  const bool text = std::ranges::all_of(answer, [](char c) { return c >= ' ' && c <= '~'; });
  if (fields.size() < 4 || fields[0].empty() || fields[1].empty() || !text)
    throw IoError(place, fmt::format("answered *IDN? with '{}'; expected vendor, model, serial "
                                     "number and firmware: is this an instrument?",
                                     printable(answer)));
  return {fields[0], fields[1], fields[2], fields[3]};
}

const GeneratorModel& identified_model(const InstrumentIdentity& identity, std::string_view place) {
  const GeneratorModel* const model = find_generator_model(identity.model);
  const auto made_by = [&](std::string_view vendor) {
    const std::string_view found = std::string_view(identity.vendor).substr(0, 7);
    return std::ranges::equal(found, vendor.substr(0, 7),
                              [](char a, char b) { return upper_case(a) == upper_case(b); });
  };
  const bool known_vendor =
      model != nullptr &&
      (made_by(model->vendor) ||
       (model->family == GeneratorFamily::keysight_trueform && made_by("Agilent")));
  if (!known_vendor)
    throw IoError(place, fmt::format("found the instrument {} of {}; expected one of {} (--model "
                                     "NAME treats a relative as one of them)",
                                     identity.model, identity.vendor, known_generators));
  return *model;
}

InstrumentIdentity identify(ScpiSession& session) {
  session.send("*IDN?\n");
  return parse_identity(session.read_line(), session.name());
}

UploadReport upload(ScpiSession& session, const UploadScript& script, const Progress& progress) {
  Uploader uploader(session, script, progress);
  try {
    return uploader.run();
  } catch (const IoError& error) {
    uploader.switch_outputs_off();
    if (!uploader.is_unsafe()) throw;
    throw IoError(session.name(), error.problem() + " OUTPUTS MAY BE ON: check the instrument");
  } catch (...) {
    uploader.switch_outputs_off();
    throw;
  }
}

}  // namespace tofsmith
