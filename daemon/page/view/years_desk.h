// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/history/loss_follower.h"
#include "daemon/page/view/years_answer.h"

namespace framewatch::daemon {

/// Learns in its own thread what the weather does to the elements, from the daily means
/// of the whole history. It begins when an answer first needs it, and goes on from there with every
/// new day.
class WeatherLearner {
 public:
  /// `config`, which has [history], must outlive this.
  explicit WeatherLearner(const Config& config);

  /// Returns what is known now, and begins to learn from the days before this time that it does not
  /// know.
  WeatherModel model(std::int64_t end_us);

 private:
  void work(const std::stop_token& stop);
  std::string learn(std::int64_t to_day, const std::stop_token& stop, WeatherEffects& out);

  const Config& config_;
  std::vector<LossFollower> followers_;  ///< used only by the thread

  std::mutex mutex_;  ///< guards the members below
  std::condition_variable_any wake_;
  std::optional<std::int64_t> wanted_day_;
  std::int64_t asked_day_ = INT64_MIN, tried_at_us_ = INT64_MIN;
  WeatherModel model_;
  std::jthread thread_;  ///< last, because it uses the members above
};

/// Reads the history for the page in a thread, one request after the other, so that no viewer of
/// the live stream waits for a disk.
class YearsDesk {
 public:
  static constexpr std::size_t kMost = 16;  ///< waiting requests

  using Done = std::function<void(YearsAnswer)>;

  /// `config`, which has [history], must outlive this.
  explicit YearsDesk(const Config& config);
  ~YearsDesk() { close(); }

  /// Queues a request. `done` is called once, in the thread. Returns false, and never calls it,
  /// when kMost requests wait, and after close().
  bool ask(YearsRequest request, Done done);
  /// Answers the requests that still wait with 503, and takes no more.
  void close();

 private:
  struct Asked {
    YearsRequest request;
    Done done;
  };
  void work(const std::stop_token& stop);
  YearsAnswer answer(const YearsRequest& request);

  const Config& config_;
  WeatherLearner learner_;
  std::mutex mutex_;  ///< guards the members below
  std::condition_variable_any wake_;
  bool closed_ = false;
  std::deque<Asked> waiting_;
  std::jthread thread_;  ///< last, because it uses the members above
};

}  // namespace framewatch::daemon
