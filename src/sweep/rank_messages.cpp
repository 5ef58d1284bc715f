// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/rank_messages.hpp"

#include <nlohmann/json.hpp>

namespace tofsmith {

namespace {

using MessageJson = nlohmann::json;

/// CBOR keeps texts as they are, also those that are not UTF-8.
std::string packed(const MessageJson& document) {
  std::string bytes;
  MessageJson::to_cbor(document, bytes);
  return bytes;
}

MessageJson unpacked(const std::string& bytes) { return MessageJson::from_cbor(bytes); }

}  // namespace

std::string bytes_of(const RankHello& hello) {
  return packed(MessageJson::array({hello.host, hello.version, hello.target}));
}

RankHello hello_of(const std::string& bytes) {
  const MessageJson document = unpacked(bytes);
  return {document.at(0).get<std::string>(), document.at(1).get<std::string>(),
          document.at(2).get<std::string>()};
}

std::string bytes_of(const std::vector<ClaimedItem>& items) {
  MessageJson document = MessageJson::array();
  for (const ClaimedItem& item : items)
    document.push_back(MessageJson::array({item.item, item.key}));
  return packed(document);
}

std::vector<ClaimedItem> items_of(const std::string& bytes) {
  std::vector<ClaimedItem> items;
  for (const MessageJson& entry : unpacked(bytes))
    items.push_back({entry.at(0).get<std::int64_t>(), entry.at(1).get<std::string>()});
  return items;
}

std::string bytes_of(const std::vector<ItemOutcome>& outcomes) {
  MessageJson document = MessageJson::array();
  for (const ItemOutcome& outcome : outcomes)
    document.push_back(
        MessageJson::array({outcome.key, outcome.result, outcome.message, outcome.seconds}));
  return packed(document);
}

std::vector<ItemOutcome> outcomes_of(const std::string& bytes) {
  std::vector<ItemOutcome> outcomes;
  for (const MessageJson& entry : unpacked(bytes))
    outcomes.push_back({entry.at(0).get<std::string>(), entry.at(1).get<std::string>(),
                        entry.at(2).get<std::string>(), entry.at(3).get<double>()});
  return outcomes;
}

}  // namespace tofsmith
