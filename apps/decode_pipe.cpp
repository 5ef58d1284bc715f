// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode_pipe.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <system_error>

#include "decode_report.hpp"
#include "interrupt.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith::apps {

namespace {

/// Polls in short steps, so that Ctrl-C is handled while no input arrives.
std::size_t read_input(std::span<std::byte> into) {
  constexpr int step_ms = 100;
  std::size_t done = 0;
  while (done < into.size()) {
    if (interrupted()) throw Interrupted();
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, step_ms) <= 0) continue;
    const ssize_t count = ::read(STDIN_FILENO, into.data() + done, into.size() - done);
    if (count < 0 && errno != EINTR && errno != EAGAIN)
      throw IoError("standard input",
                    fmt::format("cannot read: {}", std::generic_category().message(errno)));
    if (count == 0) break;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return done;
}

void write_output(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (count < 0 && errno != EINTR)
      throw IoError("standard output",
                    fmt::format("cannot write: {}", std::generic_category().message(errno)));
    if (count > 0) bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

}  // namespace

void decode_pipe(const DecodeRequest& request, const FrameBackend& backend, Session& session) {
  if (session.json)
    throw UsageError(
        "--json: standard output contains the frames of -o -; expected an output file");
  if (isatty(STDOUT_FILENO) != 0)
    throw UsageError("-o -: standard output is a terminal; expected a pipe or a file");
  // A large pipe buffer avoids transferring a frame in many small pieces. Failure is harmless.
  constexpr int pipe_bytes = 1 << 20;
  static_cast<void>(fcntl(STDIN_FILENO, F_SETPIPE_SZ, pipe_bytes));
  static_cast<void>(fcntl(STDOUT_FILENO, F_SETPIPE_SZ, pipe_bytes));
  DecodedStream result;
  const auto tell = [&] {
    fmt::print(stderr, "decoded {} frame{}{}\n", result.frames, result.frames == 1 ? "" : "s",
               result.seconds > 0.0
                   ? fmt::format(", {} frames/s as received",
                                 rate_text(static_cast<double>(result.frames) / result.seconds))
                   : "");
  };
  try {
    decode_stream(request, backend, read_input, write_output, terminal_progress("decoding"),
                  result);
  } catch (const std::invalid_argument& error) {
    throw wrong_option(error);
  } catch (...) {
    session.tells_what_is_kept = true;
    tell();
    throw;
  }
  tell();
}

}  // namespace tofsmith::apps
