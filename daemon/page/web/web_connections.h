#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemon/base/clocks.h"
#include "daemon/page/metrics/metrics.h"

namespace framewatch::daemon {

/// How many connections the page holds, and for how long.
struct ConnectionLimits {
  int waiting = 512;    ///< for their request to come whole
  int answering = 128;  ///< an answer is being read
  int viewers = 500;    ///< of the stream of events
  int viewers_per_address = 250;
  int kept_local = 32;                        ///< of each of these, for this machine
  std::size_t answer_bytes = 64 << 20;        ///< of all answers being read
  std::int64_t request_us = 10 * kSecond_us;  ///< until a request is whole
  std::int64_t answer_us = 120 * kSecond_us;  ///< until an answer is read
  unsigned idle_s = 30;                       ///< without a byte either way

  /// With those that are ended and not yet closed.
  int connections() const { return waiting + answering + viewers + 64; }
};

/// Where a connection comes from, as the limits count it.
struct PeerAddress {
  std::string text;    ///< of IPv6 the network of 64 bits, which one machine has
  bool local = false;  ///< this machine
};

/// Keeps the books of the page's connections and says which must end, so that those that dawdle
/// never keep others out: whoever comes finds a place, and the oldest of the address that holds
/// most gives it up. What this machine holds counts beyond kept_local alone. A viewer of the stream
/// keeps its place; when all are taken the next one is refused. Knows no socket: connections are
/// numbers of the caller's, times are of a clock that is never set.
class WebConnections {
 public:
  enum class Why { late_request, late_answer, crowded };
  struct Ending {
    int connection;
    Why why;
    std::string address;
  };

  explicit WebConnections(const ConnectionLimits& limits) : limits_(limits) {}

  // What happened. Each returns the connections that must end; they are counted here and forgotten
  // with closed().
  [[nodiscard]] std::vector<Ending> opened(int connection, PeerAddress from, std::int64_t now_us);
  /// Its request is whole.
  [[nodiscard]] std::vector<Ending> asked(int connection, std::int64_t now_us);
  /// An answer of so many bytes is held for it.
  [[nodiscard]] std::vector<Ending> answered(int connection, std::size_t bytes);
  [[nodiscard]] std::vector<Ending> overdue(std::int64_t now_us);
  void closed(int connection);

  /// It becomes a viewer. False when there is no place.
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
  /// In the order in which they came.
  using Connections = std::map<std::uint64_t, Connection>;
  /// By state.
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
  int viewers_elsewhere_ = 0;  ///< not of this machine
  PageUse ended_;              ///< its counters alone
};

}  // namespace framewatch::daemon
