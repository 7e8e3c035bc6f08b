// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fleet/message/message.h"

namespace framewatch::fleet {

/// A connection to the hub, for use by one thread. Calls never block; a lost connection is restored
/// automatically. Tests implement it too (tests/fleet/uplink/uplink_fixture.h).
class Link {
 public:
  virtual ~Link() = default;

  /// Hands a message over for sending. Returns false without a connection, or when it is full. True
  /// does not mean that the message arrived: that is what a reply is for.
  [[nodiscard]] virtual bool publish(const Message& message) = 0;
  /// Subscribes to a subject, whose messages take() returns. Survives new connections.
  virtual void listen(const std::string& subject) = 0;
  /// Returns the messages that came since the last call, in order.
  virtual std::vector<Message> take() = 0;

  /// Returns the number of connections made so far.
  virtual std::int64_t connections() const = 0;
  /// Returns true while connected, as far as this side knows.
  virtual bool is_connected() const = 0;
  /// Returns why the newest attempt to connect failed or a permission was denied; else empty.
  virtual std::string trouble() const = 0;
  /// Returns the subject for replies to this link without its last part: "_INBOX_kobe-03.x7q".
  /// take() returns messages to it without listen().
  virtual std::string inbox() const = 0;
};

}  // namespace framewatch::fleet
