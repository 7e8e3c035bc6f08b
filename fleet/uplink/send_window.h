#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fleet/message/key.h"
#include "fleet/message/message.h"

namespace framewatch::fleet {

/// A message on its way, with what its acknowledgement settles.
struct Outgoing {
  Message message;
  std::optional<EventKey> event;
  std::optional<SummaryKey> summary;
  std::int64_t windows = 0;  ///< of the summary, when it was read
  std::string request;       ///< of raw samples; empty: it is none
  std::int64_t piece = 0;    ///< of them
};

/// The messages that are under way: which may go out, and when one goes out again. What is not
/// acknowledged for 2 s does; but while nothing at all is acknowledged only the oldest, once a
/// second, and nothing new, so that a hub that comes back is not buried. While others are
/// acknowledged, a message that is not goes out more and more seldom. Times are of a clock that is
/// never set.
class SendWindow {
 public:
  static constexpr std::size_t kMaxMessages = 512, kMaxBytes = std::size_t{4} << 20;
  static constexpr std::int64_t kAgain_us = 2'000'000, kSilent_us = 1'500'000,
                                kOldest_us = 1'000'000, kSeldom_us = 60'000'000;

  /// Whether another message may be added.
  bool takes(std::int64_t now_us) const;
  /// Whether a message of this key is under way.
  bool has(const std::string& key) const { return keys_.contains(key); }
  std::size_t messages() const { return open_.size(); }
  std::size_t bytes() const { return bytes_; }
  /// Pieces of raw samples among them.
  std::size_t pieces() const { return pieces_; }
  std::size_t summaries() const { return summaries_; }
  std::int64_t sent_again() const { return sent_again_; }

  void add(Outgoing outgoing, std::int64_t now_us);
  /// Numbers of the messages that are to be handed to the link now, oldest first. Each of them
  /// counts as handed over.
  std::vector<std::int64_t> due(std::int64_t now_us);
  const Message& message(std::int64_t number) const { return open_.at(number).outgoing.message; }
  /// The link did not take it: as if due() had not named it.
  void not_taken(std::int64_t number, std::int64_t now_us);

  /// The message leaves the window. Empty when the number is not under way (any more).
  std::optional<Outgoing> acknowledged(std::int64_t number, std::int64_t now_us);
  /// The hub refused it: again after `wait_us`. False when it is not under way.
  bool refused(std::int64_t number, std::int64_t now_us, std::int64_t wait_us);
  /// A newer one of this subject replaces what is under way.
  void drop(const std::string& subject);
  /// A new connection: what was handed to the old one may be lost.
  void reconnected(std::int64_t now_us);

 private:
  struct Open {
    Outgoing outgoing;
    std::int64_t due_us = 0;
    int sent = 0;  ///< times
    bool refused = false;
  };
  bool silent(std::int64_t now_us) const;
  Outgoing taken(std::map<std::int64_t, Open>::iterator at);

  std::map<std::int64_t, Open> open_;  ///< by number, oldest first
  std::set<std::string> keys_;
  std::int64_t next_ = 1, heard_us_ = INT64_MIN / 2, sent_again_ = 0;
  std::size_t bytes_ = 0, pieces_ = 0, summaries_ = 0, refused_ = 0;
};

/// What a stream said of a message.
struct Verdict {
  static constexpr int kUnavailable = 503;  ///< nobody is there, or has no leader just now

  int code = kUnavailable;  ///< of an error; 0: the stream has the message
  std::string why = "what answered is no stream";
  bool duplicate = false;  ///< it had it before
};

Verdict verdict_of(const Message& answer);

}  // namespace framewatch::fleet
