// SPDX-License-Identifier: MIT
#include "drivers/lcm/multicast/fragment_assembly.h"

#include <iterator>

namespace framewatch::drivers {
namespace {

constexpr std::size_t kPartOverhead = 128;  // memory for a part of one byte

}  // namespace

std::size_t FragmentAssembly::bytes_of(const Unfinished& message) const {
  return message.payload_bytes + kPartOverhead * message.kept.size();
}

void FragmentAssembly::remove(Entry entry) {
  bytes_ -= bytes_of(*entry);
  by_sender_.erase(entry->sender);
  messages_.erase(entry);
}

void FragmentAssembly::discard(Entry entry) {
  unfinished_ += entry->unwanted ? 0 : 1;
  remove(entry);
}

/// Returns the sender's unfinished message, or a new one when the packet belongs to another
/// message.
FragmentAssembly::Entry FragmentAssembly::entry_of(const LcmSender& sender,
                                                   const LcmPacket& packet) {
  const auto known = by_sender_.find(sender);
  if (known != by_sender_.end()) {
    const Entry entry = known->second;
    if (entry->sequence == packet.sequence && entry->message_bytes == packet.message_bytes &&
        entry->parts == packet.parts) {
      messages_.splice(messages_.end(), messages_, entry);
      return entry;
    }
    discard(entry);
  }
  if (messages_.size() == kMaxSenders) discard(messages_.begin());
  messages_.emplace_back();
  const Entry entry = std::prev(messages_.end());
  entry->sender = sender;
  entry->sequence = packet.sequence;
  entry->message_bytes = packet.message_bytes;
  entry->parts = packet.parts;
  return by_sender_[sender] = entry;
}

void FragmentAssembly::ignore(Unfinished& message) {
  bytes_ -= bytes_of(message);
  message.kept.clear();
  message.payload_bytes = 0;
  message.unwanted = true;
}

/// Keeps a part. Returns false when the parts have more bytes than the message.
bool FragmentAssembly::keep(Unfinished& message, const LcmPacket& packet) {
  if (packet.payload.size() > message.message_bytes - message.payload_bytes) return false;
  message.kept[packet.part] = {packet.offset, {packet.payload.begin(), packet.payload.end()}};
  message.payload_bytes += packet.payload.size();
  bytes_ += packet.payload.size() + kPartOverhead;
  return true;
}

/// Joins the parts. Returns false unless they follow each other from beginning to end.
bool FragmentAssembly::join(const Unfinished& message, std::vector<std::uint8_t>& payload) const {
  payload.clear();
  payload.reserve(message.payload_bytes);
  for (const auto& [number, part] : message.kept) {
    if (part.offset != payload.size()) return false;
    payload.insert(payload.end(), part.payload.begin(), part.payload.end());
  }
  return payload.size() == message.message_bytes;
}

FragmentAssembly::Outcome FragmentAssembly::finish(Entry entry, std::string& channel,
                                                   std::vector<std::uint8_t>& payload) {
  const bool whole = !entry->unwanted && join(*entry, payload);
  const Outcome outcome = entry->unwanted ? Outcome::unwanted
                          : whole         ? Outcome::whole
                                          : Outcome::refused;
  channel = entry->channel;
  remove(entry);
  return outcome;
}

FragmentAssembly::Outcome FragmentAssembly::add(const LcmSender& sender, const LcmPacket& packet,
                                                std::string& channel,
                                                std::vector<std::uint8_t>& payload) {
  if (packet.message_bytes > kMaxMessageBytes) return Outcome::refused;
  const Entry entry = entry_of(sender, packet);
  if (entry->kept.contains(packet.part)) return Outcome::refused;
  if (packet.part == 0 && !entry->unwanted) {
    entry->channel = packet.channel;
    if (!wanted_(packet.channel)) ignore(*entry);
  }
  if (!entry->unwanted && !keep(*entry, packet)) {
    discard(entry);
    return Outcome::refused;
  }
  if (++entry->parts_came == entry->parts) return finish(entry, channel, payload);
  const bool unwanted = entry->unwanted;
  while (bytes_ > kMaxBytes) discard(messages_.begin());
  return unwanted ? Outcome::unwanted : Outcome::waits;
}

}  // namespace framewatch::drivers
