// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fleet/link/link.h"
#include "fleet/store/fleet_store.h"

namespace framewatch::fleet {

/// Limits the messages of a building in an hour to more than an uplink sends while it catches up (4
/// older summaries a second) or sends raw samples (2000 kbit/s). Messages beyond the limit are
/// counted, not stored.
class FloodGate {
 public:
  static constexpr std::int64_t kMessages = 20'000, kBytes = 1'000'000'000;

  explicit FloodGate(std::int64_t most_messages = kMessages, std::int64_t most_bytes = kBytes)
      : most_messages_(most_messages), most_bytes_(most_bytes) {}

  /// Counts a message of `bytes` in the hour of `hub_us` (UTC). Returns false if it is over the
  /// limit.
  bool takes(const std::string& building, std::size_t bytes, std::int64_t hub_us);
  /// Returns the messages over the limit since the last call.
  std::vector<ReceivedFlood> take_floods();

 private:
  struct Said {
    std::int64_t messages = 0, bytes = 0;  ///< in this hour
    std::int64_t flood_messages = 0, flood_bytes = 0;
  };
  std::int64_t most_messages_, most_bytes_;
  std::int64_t hour_us_ = 0;
  std::map<std::string, Said> said_;
  std::vector<ReceivedFlood> floods_;  ///< of past hours
};

/// The result of storing a batch. lasting: the content is the cause, so that a retry would fail.
struct StoreOutcome {
  std::string problem;  ///< empty if stored
  bool lasting = false;
};
using StoreSink = std::function<StoreOutcome(const FleetBatch&)>;

/// Returns the starts of days (us, UTC) of which the database has less than the building, newest
/// first. Returns nullopt if that is unknown now.
using MissingDays =
    std::function<std::optional<std::vector<std::int64_t>>(const std::string& building)>;

/// The two clocks of a worker.
struct WorkerTime {
  std::int64_t steady_us = 0;  ///< monotonic
  std::int64_t hub_us = 0;     ///< UTC
};

/// Takes messages of buildings from the hub's consumers, stores them and acknowledges what is
/// stored. No message is lost, and a repeated message changes nothing. Any number of workers may
/// share the consumers.
class Worker {
 public:
  static constexpr std::size_t kMaxMessages = 500;      ///< in a batch
  static constexpr std::int64_t kLongest_us = 500'000;  ///< time to collect a batch
  static constexpr std::int64_t kPull_us = 5'000'000;   ///< time that the hub holds a request
  /// Time between an inventory and its comparison, so that messages under way arrive first.
  static constexpr std::int64_t kBeforeCompared_us = 1'800'000'000;
  /// Days of one building that are requested again; inventories that wait.
  static constexpr std::size_t kMaxResent_days = 5, kMaxCompared = 20'000;
  static constexpr std::int64_t kShortestPause_us = 1'000'000, kLongestPause_us = 30'000'000;

  struct Counters {
    std::int64_t stored = 0;                              ///< messages
    std::int64_t refused = 0, unknown = 0, flooding = 0;  ///< included in `stored`
    std::int64_t batches = 0;
    std::int64_t resends = 0;  ///< days that were requested again
    std::string trouble;       ///< why the newest batch was not stored
  };

  Worker(Link& link, StoreSink store, MissingDays missing = {}, FloodGate gate = FloodGate());

  /// Does what is due. Waits only for the store.
  void step(const WorkerTime& now);
  /// Stores and acknowledges the collected messages. Call it at the end.
  void finish(const WorkerTime& now);
  const Counters& counters() const { return counters_; }

 private:
  struct Consumer {
    const char *stream, *name;
    std::string inbox = {};
    std::int64_t asked_us = 0;  ///< 0: no request
    std::size_t lacking = 0;    ///< missing messages of the request
  };

  void ask(Consumer& consumer, std::int64_t steady_us);
  void take(Message message, const WorkerTime& now);
  void store(const WorkerTime& now);
  void store_one_by_one(std::size_t within, std::vector<ReceivedFlood> floods,
                        const WorkerTime& now);
  std::size_t put_floods_last(const WorkerTime& now);
  void acknowledge(const Message& message);
  void give_back(const Message& message);
  void count(const FleetBatch& batch, std::size_t messages);
  void note_inventories(const FleetBatch& batch, std::int64_t steady_us);
  void compare_inventories(const WorkerTime& now);
  void ask_again(const std::string& building, std::int64_t from_us, const WorkerTime& now);

  Link& link_;
  StoreSink store_;
  MissingDays missing_;
  FloodGate gate_;
  std::map<std::string, std::int64_t> to_compare_;  ///< due time (steady clock) by building
  std::vector<Consumer> consumers_;
  std::vector<Message> waiting_;
  std::int64_t since_us_ = 0;  ///< arrival of the oldest in waiting_
  std::int64_t connections_ = 0;
  std::int64_t pause_us_ = 0, pause_until_us_ = 0;
  Counters counters_;
};

}  // namespace framewatch::fleet
