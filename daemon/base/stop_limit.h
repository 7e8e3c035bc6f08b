// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace framewatch::daemon {

/// Bounds the time that a program takes to stop, whatever a disk or a database does. `limit` after
/// the stop was requested, it logs which parts of the stop are not done and ends the process at
/// once, with status kFailed.
class StopLimit {
 public:
  /// `requested` tells whether a stop was requested. `give_up` ends the process; it is not called
  /// after the destructor has begun.
  explicit StopLimit(std::function<bool()> requested, std::chrono::milliseconds limit,
                     std::function<void()> give_up = &end_process);
  /// The stop is complete.
  ~StopLimit();

  /// Sets the parts that are left: each names something and what becomes of it.
  void left(std::vector<std::string> parts);
  /// A part is done.
  void done(const std::string& part);

 private:
  static void end_process();
  void watch();

  std::function<bool()> requested_;
  std::chrono::milliseconds limit_;
  std::function<void()> give_up_;
  std::mutex mutex_;  ///< guards the members below
  std::condition_variable wake_;
  bool ended_ = false;
  std::vector<std::string> left_;
  std::thread thread_;  ///< last, because it uses the members above
};

}  // namespace framewatch::daemon
