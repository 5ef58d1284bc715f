// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tofsmith/core/progress.hpp"
#include "tofsmith/instrument/scpi_session.hpp"
#include "tofsmith/instrument/upload_script.hpp"

namespace tofsmith {

/// A step that went well.
struct UploadedStep {
  std::string what, sent, answer;  ///< answer: "" for none, large ones summarized
};

/// A number that the instrument says of itself, next to what it was told.
struct ReadBackNumber {
  int channel = 0;  ///< 0: none
  std::string quantity;
  double told = 0.0, read_back = 0.0;
};

/// What an upload did.
struct UploadReport {
  bool verified = false;  ///< all points and all settings were read back and are as told
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
