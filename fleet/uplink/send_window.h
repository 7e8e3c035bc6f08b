// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fleet/message/address.h"
#include "fleet/message/message.h"

namespace framewatch::fleet {

/// A message under way, with the data that its acknowledgement confirms.
struct Outgoing {
  Message message;
  std::optional<EventKey> event;
  std::optional<SummaryKey> summary;
  std::int64_t windows = 0;  ///< windows of the summary when it was read
  std::string request;       ///< request of raw samples; empty for other messages
  std::int64_t piece = 0;    ///< number of the piece of raw samples
};

/// Holds the messages under way and decides when each is sent. A message is sent again after 2 s
/// without an acknowledgement, and at growing intervals while others are acknowledged. While the
/// hub acknowledges nothing, only the oldest message is sent, once a second, so that a returning
/// hub is not overloaded. Times are of a monotonic clock.
class SendWindow {
 public:
  static constexpr std::size_t kMaxMessages = 512, kMaxBytes = std::size_t{4} << 20;
  static constexpr std::int64_t kAgain_us = 2'000'000, kSilent_us = 1'500'000,
                                kOldest_us = 1'000'000, kSeldom_us = 60'000'000;

  /// Returns true if another message may be added.
  bool takes(std::int64_t now_us) const;
  /// Returns true if a message with this key is under way.
  bool has(const std::string& key) const { return keys_.contains(key); }
  std::size_t messages() const { return open_.size(); }
  std::size_t bytes() const { return bytes_; }
  /// Returns the number of pieces of raw samples among the messages.
  std::size_t pieces() const { return pieces_; }
  std::size_t summaries() const { return summaries_; }
  std::int64_t sent_again() const { return sent_again_; }

  void add(Outgoing outgoing, std::int64_t now_us);
  /// Returns the numbers of the messages to send now, oldest first, and counts them as sent.
  std::vector<std::int64_t> due(std::int64_t now_us);
  const Message& message(std::int64_t number) const { return open_.at(number).outgoing.message; }
  /// Reverses due() for a message that the link did not accept.
  void not_taken(std::int64_t number, std::int64_t now_us);

  /// Removes and returns the message. Returns nullopt if the number is not under way.
  std::optional<Outgoing> acknowledged(std::int64_t number, std::int64_t now_us);
  /// Sends a message that the hub refused again after `wait_us`. Returns false if it is not under
  /// way.
  bool refused(std::int64_t number, std::int64_t now_us, std::int64_t wait_us);
  /// Removes messages with this subject, because a newer one replaces them.
  void drop(const std::string& subject);
  /// Makes all messages due after a new connection, because the old one may have lost them.
  void reconnected(std::int64_t now_us);

 private:
  struct Open {
    Outgoing outgoing;
    std::int64_t due_us = 0;
    int sent = 0;  ///< number of times
    bool refused = false;
  };
  bool silent(std::int64_t now_us) const;
  Outgoing taken(std::map<std::int64_t, Open>::iterator at);

  std::map<std::int64_t, Open> open_;  ///< by number, oldest first
  std::set<std::string> keys_;
  std::int64_t next_ = 1, heard_us_ = INT64_MIN / 2, sent_again_ = 0;
  std::size_t bytes_ = 0, pieces_ = 0, summaries_ = 0, refused_ = 0;
};

/// The answer of a stream to a message.
struct Verdict {
  static constexpr int kUnavailable = 503;  ///< no stream, or no leader at the moment

  int code = kUnavailable;  ///< error code; 0: the stream has the message
  std::string why = "the answer is not from a stream";
  bool duplicate = false;  ///< the stream had the message before
};

/// Parses the answer of a stream.
Verdict verdict_of(const Message& answer);

}  // namespace framewatch::fleet
