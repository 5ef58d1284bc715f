// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/store_state.hpp"

namespace tofsmith {

bool WorkerWatch::may_live(SqliteDatabase& database, const std::string& id) {
  if (id.empty()) return false;
  if (id == own_.id) return true;
  SqliteStatement query =
      database.prepare("SELECT machine, process, process_start, beat FROM workers WHERE id = ?");
  if (!query.bind(1, id).step()) return false;
  const ProcessIdentity worker{query.text(0), query.integer(1), query.text(2)};
  const std::int64_t beat = query.integer(3);
  if (is_surely_gone(worker, own_.process)) return false;

  const Clock::time_point now = Clock::now();
  const auto [seen, is_new] = seen_.try_emplace(id, Seen{beat, now});
  if (!is_new && seen->second.beat != beat) seen->second = {beat, now};
  return std::chrono::duration<double>(now - seen->second.since).count() < lease_s_;
}

void SweepStore::State::register_worker() {
  SqliteTransaction transaction(database());
  // Those that are surely gone leave no row behind: what is theirs is free then.
  std::vector<std::string> gone;
  SqliteStatement workers =
      database().prepare("SELECT id, machine, process, process_start FROM workers");
  while (workers.step())
    if (is_surely_gone({workers.text(1), workers.integer(2), workers.text(3)}, watch.own().process))
      gone.push_back(workers.text(0));
  SqliteStatement remove = database().prepare("DELETE FROM workers WHERE id = ?");
  for (const std::string& id : gone) remove.bind(1, id).run();

  const WorkerIdentity& own = watch.own();
  database()
      .prepare("INSERT INTO workers VALUES (?, ?, ?, ?, ?, 0)")
      .bind(1, own.id)
      .bind(2, own.host)
      .bind(3, own.process.machine)
      .bind(4, own.process.number)
      .bind(5, own.process.start)
      .run();
  transaction.commit();
  is_registered = true;
}

}  // namespace tofsmith
