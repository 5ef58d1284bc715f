// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/mpi_world.hpp"

#include <charconv>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#ifdef TOFSMITH_HAS_MPI
#include <mpi.h>
#endif

namespace tofsmith {

namespace {

int environment_number(const char* variable) {
  const char* const value = std::getenv(variable);
  if (value == nullptr) return 0;
  const std::string_view text(value);
  int number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

}  // namespace

int launched_processes() {
  if (const int size = environment_number("OMPI_COMM_WORLD_SIZE"); size > 0) return size;
  // Under srun, where each step says how many there are of it.
  const bool has_rank = std::getenv("PMIX_RANK") != nullptr;
  const int size = has_rank ? environment_number("SLURM_STEP_NUM_TASKS") : 1;
  return size > 0 ? size : 1;
}

#ifdef TOFSMITH_HAS_MPI

struct MpiWorld::Sending {
  std::string bytes;
  MPI_Request request = MPI_REQUEST_NULL;
};

MpiWorld::MpiWorld() {
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  if (provided >= MPI_THREAD_FUNNELED) return;
  MPI_Finalize();
  throw std::runtime_error("this MPI cannot be used beside threads; use one that can");
}

MpiWorld::~MpiWorld() { MPI_Finalize(); }

void MpiWorld::send(int rank, int tag, std::string bytes) {
  // A blocking send of two ranks to each other would wait forever.
  auto& sending =
      sending_.emplace_back(std::make_unique<Sending>(Sending{std::move(bytes), MPI_REQUEST_NULL}));
  MPI_Isend(sending->bytes.data(), static_cast<int>(sending->bytes.size()), MPI_BYTE, rank, tag,
            MPI_COMM_WORLD, &sending->request);
}

std::optional<RankMessage> MpiWorld::receive() {
  all_sent();
  int is_there = 0;
  MPI_Message message = MPI_MESSAGE_NULL;
  MPI_Status status;
  MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &is_there, &message, &status);
  if (is_there == 0) return std::nullopt;
  int count = 0;
  MPI_Get_count(&status, MPI_BYTE, &count);
  RankMessage received{status.MPI_SOURCE, status.MPI_TAG,
                       std::string(static_cast<std::size_t>(count), '\0')};
  MPI_Mrecv(received.bytes.data(), count, MPI_BYTE, &message, &status);
  return received;
}

bool MpiWorld::all_sent() {
  sending_.remove_if([](const std::unique_ptr<Sending>& sending) {
    int has_left = 0;
    MPI_Test(&sending->request, &has_left, MPI_STATUS_IGNORE);
    return has_left != 0;
  });
  return sending_.empty();
}

void MpiWorld::end_all(int exit_code) {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  throw std::runtime_error("the other processes could not be ended");
}

#else

struct MpiWorld::Sending {};

MpiWorld::MpiWorld() {
  throw std::runtime_error(
      "started as one of several processes, but this tofsmith was built without MPI; install "
      "libopenmpi-dev and build it again, or start one process a machine with --shard i/n");
}
MpiWorld::~MpiWorld() = default;
void MpiWorld::send(int, int, std::string) {}
std::optional<RankMessage> MpiWorld::receive() { return std::nullopt; }
bool MpiWorld::all_sent() { return true; }
void MpiWorld::end_all(int) { throw std::logic_error("there are no other processes to end"); }

#endif

}  // namespace tofsmith
