// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/run_sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "sweep/item_key.hpp"
#include "sweep/store_file.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<std::string> keys = {"aa", "bb", "cc"};

SweepStore with_items(const std::filesystem::path& path, const SweepStoreOptions& options = {}) {
  SweepStore store = SweepStore::open(path, options);
  store.add(keys, [](std::size_t i) { return "{\"i\":" + std::to_string(i) + "}"; });
  return store;
}

void run_sql(const std::filesystem::path& path, const std::string& statements) {
  SqliteDatabase(path, SqliteDatabase::Access::write).execute(statements);
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(SweepStore, KeepsStoredResults) {
  const TemporaryDirectory directory;
  const auto path = directory / "s.sqlite";
  {
    SweepStore store = with_items(path);
    store.claim(keys, 2);
    store.finish(std::vector<ItemOutcome>{{"aa", "{}", "", 1.5}, {"bb", "", "no such code", 0.5}});
  }
  EXPECT_EQ(directory.files(), 1);  // no journal remains
  SweepStore store = SweepStore::read(path);
  EXPECT_EQ(store.find("aa")->result, "{}");
  EXPECT_EQ(store.find("aa")->settings, "{\"i\":0}");
  EXPECT_EQ(store.find("bb")->status, ItemStatus::failed);
  EXPECT_EQ(store.find("bb")->message, "no such code");
  EXPECT_FALSE(store.find("dd").has_value());
  const SweepCounts counts = store.count(keys);
  EXPECT_EQ(counts.finished, 1);
  EXPECT_EQ(counts.failed, 1);
  EXPECT_EQ(counts.pending, 1);
  EXPECT_EQ(counts.seconds, 1.5);
}

TEST(SweepStore, ItemsRunningElsewhereAreClaimedOnRequestOnly) {
  const TemporaryDirectory directory;
  SweepStore first = with_items(directory / "s.sqlite");
  SweepStore second = with_items(directory / "s.sqlite");
  EXPECT_THAT(first.claim(keys, 1), ElementsAre(ClaimAnswer::ours));
  EXPECT_THAT(second.claim(keys, 1), ElementsAre(ClaimAnswer::running, ClaimAnswer::ours));
  first.finish(std::vector<ItemOutcome>{{"aa", "{}", "", 1.0}});
  EXPECT_THAT(second.claim(keys, 5),
              ElementsAre(ClaimAnswer::finished, ClaimAnswer::running, ClaimAnswer::ours));
  EXPECT_THAT(first.claim(keys, 5, true),
              ElementsAre(ClaimAnswer::finished, ClaimAnswer::ours, ClaimAnswer::ours));
  second.release(std::vector<std::string>{"aa", "bb"});
  EXPECT_THAT(first.claim(keys, 5),
              ElementsAre(ClaimAnswer::finished, ClaimAnswer::ours, ClaimAnswer::running));
}

TEST(SweepStore, AFinishedItemIsNotChanged) {
  const TemporaryDirectory directory;
  SweepStore store = with_items(directory / "s.sqlite");
  store.finish(std::vector<ItemOutcome>{{"aa", "{}", "", 1.0}});
  store.finish(std::vector<ItemOutcome>{{"aa", "[]", "", 2.0}, {"aa", "", "failed", 2.0}});
  EXPECT_EQ(store.find("aa")->result, "{}");
}

TEST(SweepStore, ContinuesAndMergesAStoreOfVersion1) {
  const TemporaryDirectory directory;
  const auto path = directory / "old.sqlite";
  { const SweepStore store = with_items(path); }
  run_sql(path,
          "PRAGMA user_version = 1;"
          "DROP TABLE items;"
          "CREATE TABLE items (key TEXT PRIMARY KEY, settings TEXT NOT NULL, status TEXT NOT NULL,"
          " result TEXT, checksum TEXT, message TEXT, worker TEXT, host TEXT, started TEXT,"
          " finished TEXT, seconds REAL);"
          "CREATE TABLE workers (id TEXT PRIMARY KEY, host TEXT, machine TEXT, process INTEGER,"
          " process_start TEXT, beat INTEGER NOT NULL) WITHOUT ROWID;"
          "INSERT INTO items (key, settings, status, worker) VALUES ('aa', '{}', 'running', 'x')");
  {
    SweepStore store = with_items(path);
    EXPECT_THAT(store.claim(keys, 5),
                ElementsAre(ClaimAnswer::running, ClaimAnswer::ours, ClaimAnswer::ours));
    store.finish(std::vector<ItemOutcome>{{"aa", "{}", "", 1.0}});
  }
  SweepStore::merge(directory / "new.sqlite", std::vector<std::filesystem::path>{path});
  EXPECT_EQ(SweepStore::read(directory / "new.sqlite").find("aa")->result, "{}");
}

TEST(SweepStore, RejectsOtherFilesWithoutChangingThem) {
  const TemporaryDirectory directory;
  const auto text = directory / "notes.txt", other = directory / "other.sqlite";
  std::ofstream(text) << "camera = \"paper-10f0\"\n";
  run_sql(other, "CREATE TABLE birds (name TEXT)");
  for (const auto& path : {text, other}) {
    const std::string before = bytes_of(path);
    EXPECT_THAT(
        [&] { SweepStore::open(path); },
        ThrowsMessage<IoError>(AllOf(HasSubstr(path.string()), HasSubstr("expected a store"))));
    EXPECT_THAT([&] { SweepStore::read(path); },
                ThrowsMessage<IoError>(HasSubstr("expected a store of tofsmith sweep")));
    EXPECT_EQ(bytes_of(path), before);
  }
  EXPECT_THAT([&] { SweepStore::read(directory / "none.sqlite"); },
              ThrowsMessage<IoError>(HasSubstr("there is no such store")));
  EXPECT_THAT([&] { SweepStore::open(directory / "none" / "s.sqlite"); },
              ThrowsMessage<IoError>(HasSubstr("cannot open")));
  EXPECT_THAT([&] { SweepStore::open(directory.path()); },
              ThrowsMessage<IoError>(HasSubstr("is not a regular file")));
}

TEST(SweepStore, RejectsOtherVersionsAndOtherInstructionSets) {
  const TemporaryDirectory directory;
  const auto path = directory / "s.sqlite";
  const auto refuse = [&](const std::string& change, const char* problem) {
    std::filesystem::remove(path);
    { const SweepStore store = with_items(path); }
    run_sql(path, change);
    EXPECT_THAT([&] { SweepStore::open(path); }, ThrowsMessage<IoError>(HasSubstr(problem)));
  };
  refuse("PRAGMA user_version = 99", "store version 99");
  refuse("UPDATE meta SET value = '99' WHERE name = 'results'", "results 99");
  refuse("UPDATE meta SET value = 'ABACUS' WHERE name = 'target'", "was computed on ABACUS");
  EXPECT_NO_THROW(SweepStore::read(path));  // but its results can be read
}

TEST(SweepStore, RejectsADamagedStore) {
  const TemporaryDirectory directory;
  const auto path = directory / "s.sqlite";
  {
    SweepStore store = with_items(path);
    store.finish(std::vector<ItemOutcome>{{"aa", "{\"linear\":1}", "", 1.0}});
  }
  const std::string whole = bytes_of(path);
  const auto write = [&](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
  };
  write(whole.substr(0, whole.size() / 2));
  EXPECT_THROW(SweepStore::open(path), IoError);
  std::string changed = whole;
  changed[changed.find("\"linear\":1") + 9] = '2';
  write(changed);
  EXPECT_THAT([&] { SweepStore::open(path).find("aa"); },
              ThrowsMessage<IoError>(HasSubstr("checksum")));
  for (std::size_t at = 0; at < whole.size(); at += 509) {  // must not crash
    changed = whole;
    changed[at] = static_cast<char>(~changed[at]);
    write(changed);
    try {
      SweepStore store = SweepStore::read(path);
      const auto item = store.find("aa");
      EXPECT_TRUE(!item || item->result.empty() || item->result == "{\"linear\":1}") << at;
    } catch (const IoError&) {
    }
  }
}

TEST(SweepStore, RejectsResultsThatAreNotObjects) {
  for (const char* const damaged : {"1", "[]", "\"a\"", "null"})
    EXPECT_THAT([&] { parse_item_result(damaged, "code", "item aa"); },
                ThrowsMessage<IoError>(
                    AllOf(HasSubstr("item aa"), HasSubstr("expected the result of an item"))));
}

TEST(SweepStore, AFullDiskLosesNothing) {
  const TemporaryDirectory directory;
  const auto path = directory / "s.sqlite";
  { const SweepStore store = with_items(path); }
  SqliteDatabase full(path, SqliteDatabase::Access::write);
  full.execute("PRAGMA max_page_count = 1");
  EXPECT_THAT(
      [&] { full.execute("INSERT INTO meta VALUES ('x', hex(zeroblob(100000)))"); },
      ThrowsMessage<IoError>(AllOf(HasSubstr("full"), HasSubstr("finished items are kept"))));
  EXPECT_EQ(SweepStore::open(path).count(keys).pending, 3);
}

TEST(SweepStore, UsesARollbackJournalOnNetworkFileSystemsAndRejectsWalStoresThere) {
  const TemporaryDirectory directory;
  const auto here = directory / "here.sqlite", there = directory / "there.sqlite";
  { const SweepStore store = with_items(here); }
  { const SweepStore store = with_items(there, {.network_file_system = "NFS"}); }
  EXPECT_EQ(bytes_of(here)[18], 2);
  EXPECT_EQ(bytes_of(there)[18], 1);
  EXPECT_THAT([&] { SweepStore::open(here, {.network_file_system = "NFS"}); },
              ThrowsMessage<IoError>(AllOf(HasSubstr("NFS"), HasSubstr("merge"))));
  EXPECT_NO_THROW(SweepStore::open(there, {.network_file_system = "NFS"}));
  EXPECT_EQ(network_file_system(0x6969), "NFS");
  EXPECT_EQ(network_file_system(0xff534d42), "CIFS");
  EXPECT_EQ(network_file_system(0xef53), "");  // ext4
}

TEST(SweepStore, MergingCombinesFinishedItemsInAnyOrder) {
  const TemporaryDirectory directory;
  const auto a = directory / "a.sqlite", b = directory / "b.sqlite";
  with_items(a).finish(std::vector<ItemOutcome>{{"aa", "{}", "", 1.0}, {"bb", "[1]", "", 2.0}});
  with_items(b).finish(std::vector<ItemOutcome>{{"bb", "[1]", "", 1.0}, {"cc", "", "failed", 1.0}});
  const auto merged = [&](const std::string& name, const std::filesystem::path& first,
                          const std::filesystem::path& second) {
    SweepStore::merge(directory / name, std::vector<std::filesystem::path>{first, second});
    return SweepStore::read(directory / name);
  };
  SweepStore ab = merged("ab.sqlite", a, b), ba = merged("ba.sqlite", b, a);
  for (SweepStore* store : {&ab, &ba}) {
    EXPECT_EQ(store->count(keys).finished, 2);
    EXPECT_EQ(store->find("bb")->result, "[1]");
    EXPECT_EQ(store->find("bb")->seconds, 1.0);
  }
  run_sql(b, "UPDATE items SET result = NULL, status = 'pending' WHERE key = 'bb'");
  with_items(b).finish(std::vector<ItemOutcome>{{"bb", "[2]", "", 1.0}});
  EXPECT_THAT([&] { merged("c.sqlite", a, b); },
              ThrowsMessage<IoError>(HasSubstr("has a different result")));
}

}  // namespace
}  // namespace tofsmith
