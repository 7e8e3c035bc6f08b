// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemon/base/clocks.h"
#include "daemon/page/metrics/metrics.h"

namespace framewatch::daemon {

/// Limits on the number, size and age of the page's connections.
struct ConnectionLimits {
  int waiting = 512;    ///< whose request is incomplete
  int answering = 128;  ///< that read an answer
  int viewers = 500;    ///< of the event stream
  int viewers_per_address = 250;
  int kept_local = 32;                        ///< reserved for this machine in each state
  std::size_t answer_bytes = 64 << 20;        ///< in all answers together
  std::int64_t request_us = 10 * kSecond_us;  ///< until a request is complete
  std::int64_t answer_us = 120 * kSecond_us;  ///< until an answer is read
  unsigned idle_s = 30;                       ///< without a byte in either direction

  /// Returns the most connections that may exist, including ended ones that are not yet closed.
  int connections() const { return waiting + answering + viewers + 64; }
};

/// The origin of a connection, as the limits count it.
struct PeerAddress {
  std::string text;    ///< for IPv6 the 64-bit network, which belongs to one machine
  bool local = false;  ///< this machine
};

/// Tracks the page's connections and decides which must end, so that slow clients never keep others
/// out. A new connection always gets a place: the oldest connection of the address that holds most
/// ends. Connections of this machine count only beyond kept_local. Viewers of the stream keep their
/// place; when all places are taken, the next viewer is refused. Connections are numbers chosen by
/// the caller; times are of a monotonic clock.
class WebConnections {
 public:
  enum class Why { late_request, late_answer, crowded };
  struct Ending {
    int connection;
    Why why;
    std::string address;
  };

  explicit WebConnections(const ConnectionLimits& limits) : limits_(limits) {}

  // Each function takes an event of a connection and returns the connections that must end. Those
  // are counted here until closed().
  [[nodiscard]] std::vector<Ending> opened(int connection, PeerAddress from, std::int64_t now_us);
  /// The request is complete.
  [[nodiscard]] std::vector<Ending> asked(int connection, std::int64_t now_us);
  /// An answer of `bytes` waits to be read.
  [[nodiscard]] std::vector<Ending> answered(int connection, std::size_t bytes);
  [[nodiscard]] std::vector<Ending> overdue(std::int64_t now_us);
  void closed(int connection);

  /// The connection becomes a viewer. Returns false when no place is free.
  [[nodiscard]] bool watches(int connection);

  PageUse use() const;

 private:
  enum class State { waiting, answering, watching, ended };
  struct Connection {
    int connection;
    PeerAddress from;
    State state;
    std::int64_t since_us;
    std::size_t bytes;
  };
  /// In the order of opened().
  using Connections = std::map<std::uint64_t, Connection>;
  /// Number of connections in each state.
  struct Held {
    int waiting = 0, answering = 0, watching = 0, ended = 0;
    bool local = false;
  };

  Connection* find(int connection);
  static int& of(State state, Held& held);
  void enter(Connection& connection, State state);
  Connection* most_dispensable(State state, const Connection& keep);
  std::vector<Ending> crowded_out(State state, const Connection& keep);
  Ending end(Connection& connection, Why why);

  const ConnectionLimits limits_;
  std::uint64_t next_ = 0;
  Connections connections_;
  std::map<int, std::uint64_t> numbers_;
  std::map<std::string, Held> held_;  ///< by address
  std::size_t answer_bytes_ = 0;
  Held all_;
  int viewers_elsewhere_ = 0;  ///< on other machines
  PageUse ended_;              ///< only the counters are used
};

}  // namespace framewatch::daemon
