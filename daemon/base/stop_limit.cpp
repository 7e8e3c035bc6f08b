// SPDX-License-Identifier: MIT
#include "daemon/base/stop_limit.h"

#include <cstdlib>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/log.h"
#include "daemon/base/words.h"

namespace framewatch::daemon {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kBetweenLooks{200};

}  // namespace

StopLimit::StopLimit(std::function<bool()> requested, std::chrono::milliseconds limit,
                     std::function<void()> give_up)
    : requested_(std::move(requested)),
      limit_(limit),
      give_up_(std::move(give_up)),
      thread_([this] { watch(); }) {}

StopLimit::~StopLimit() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void StopLimit::left(std::vector<std::string> parts) {
  const std::lock_guard<std::mutex> lock(mutex_);
  left_ = std::move(parts);
}

void StopLimit::done(const std::string& part) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::erase(left_, part);
}

void StopLimit::end_process() {
  std::_Exit(kFailed);
}

void StopLimit::watch() {
  std::optional<Clock::time_point> until;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ended_ && (!until || Clock::now() < *until)) {
    if (!until && requested_()) until = Clock::now() + limit_;
    wake_.wait_for(lock, kBetweenLooks, [this] { return ended_; });
  }
  if (ended_) return;
  log(LogLevel::error, fmt::format("gave up {} s after the stop was requested. Not done: {}",
                                   std::chrono::duration<double>(limit_).count(),
                                   left_.empty() ? "the work under way" : listed(left_)));
  give_up_();
}

}  // namespace framewatch::daemon
