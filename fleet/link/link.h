#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fleet/message/message.h"

namespace framewatch::fleet {

/// A line to the hub, used by one thread. It never waits, and a connection that is lost comes back
/// by itself. Tests have one of their own (tests/fleet/support).
class Link {
 public:
  virtual ~Link() = default;

  /// Hands a message over; false: there is no connection, or it takes nothing. True says nothing of
  /// its arrival: that is what a reply is for.
  [[nodiscard]] virtual bool publish(const Message& message) = 0;
  /// Messages of this subject come out of take(), after every new connection too.
  virtual void listen(const std::string& subject) = 0;
  /// What has come since the last call, in its order.
  virtual std::vector<Message> take() = 0;

  /// How many connections there have been so far.
  virtual std::int64_t connections() const = 0;
  /// Whether one stands, as far as this side knows.
  virtual bool is_connected() const = 0;
  /// Why the newest attempt to connect failed, or a permission was denied; empty: neither.
  virtual std::string trouble() const = 0;
  /// Of a subject for replies to this link alone, without the last part: "_INBOX_kobe-03.x7q". What
  /// is sent to it comes out of take(), without listen().
  virtual std::string inbox() const = 0;
};

}  // namespace framewatch::fleet
