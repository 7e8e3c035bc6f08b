#include "daemon/monitor/actions/notifier.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "drivers/files/caught.h"

namespace framewatch::daemon {
namespace {

constexpr std::chrono::milliseconds kLook{100};
constexpr std::int64_t kPatienceAtEnd_us = 2'000'000;
constexpr double kFirstWait_s = 1, kLongestWait_s = 60;

}  // namespace

Notifier::Notifier(std::string name, Deliver deliver)
    : name_(std::move(name)), deliver_(std::move(deliver)), thread_([this] { work(); }) {}

Notifier::~Notifier() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
    give_up_us_ = steady_clock_us() + kPatienceAtEnd_us;
  }
  wake_.notify_one();
  thread_.join();
}

void Notifier::configure(const ActionSettings& settings, double patience_s) {
  const std::lock_guard<std::mutex> lock(mutex_);
  settings_ = settings;
  patience_s_ = patience_s;
  queue_.configure(settings);
}

void Notifier::delivered_before(const event_t& event) {
  const std::lock_guard<std::mutex> lock(mutex_);
  queue_.delivered_before(event);
}

void Notifier::event(const event_t& event, bool acknowledged) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const int lost = queue_.put(event, acknowledged, steady_clock_us());
    if (lost > 0) lose(lost, "too many wait");
  }
  wake_.notify_one();
}

void Notifier::acknowledged(const event_t& event) {
  const std::lock_guard<std::mutex> lock(mutex_);
  queue_.acknowledged(event);
}

Notifier::Counters Notifier::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  Counters out = counters_;
  out.merged = queue_.merged();
  out.waiting += static_cast<std::int64_t>(queue_.waiting());
  return out;
}

/// The caller holds the mutex.
void Notifier::lose(std::int64_t events, const std::string& why) {
  counters_.lost += events;
  counters_.lost_us = host_clock_us();
  losses_(host_clock_us(), fmt::format("{}: {} events are lost: {}", name_, events, why));
}

bool Notifier::abandoned() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return steady_clock_us() >= give_up_us_;
}

void Notifier::work() {
  for (;;) {
    std::optional<event_t> event;
    ActionSettings settings;
    double patience_s = 0;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      const bool late = steady_clock_us() >= give_up_us_;
      if (stop_ && (late || queue_.waiting() == 0)) {
        if (queue_.waiting() > 0)
          lose(static_cast<std::int64_t>(queue_.waiting()), "framewatch is stopped");
        return;
      }
      event = stop_ ? queue_.take_any() : queue_.take(steady_clock_us());
      if (!event) {
        wake_.wait_for(lock, kLook);
        continue;
      }
      settings = settings_;
      patience_s = patience_s_;
      counters_.waiting = 1;
    }
    bool delivered = false;
    const std::string thrown =
        drivers::caught([&] { delivered = deliver_one(settings, patience_s, *event); });
    const std::lock_guard<std::mutex> lock(mutex_);
    counters_.waiting = 0;
    if (!thrown.empty()) counters_.trouble = thrown;
    if (delivered)
      ++counters_.told;
    else
      lose(1, fmt::format("{}; it was \"{}\"", counters_.trouble, event->message));
  }
}

bool Notifier::deliver_one(ActionSettings settings, double patience_s, const event_t& event) {
  const std::int64_t began_us = steady_clock_us();
  for (double wait_s = kFirstWait_s;; wait_s = std::min(2 * wait_s, kLongestWait_s)) {
    DeliveryResult result = deliver_(settings, event, [this] { return abandoned(); });
    std::unique_lock<std::mutex> lock(mutex_);
    const std::string before = std::exchange(counters_.trouble, result.trouble);
    if (result.trouble.empty()) {
      if (!before.empty()) log(LogLevel::notice, name_ + ": works again");
      return true;
    }
    if (result.trouble != before) log(LogLevel::warning, name_ + ": " + result.trouble);
    const auto wait_us = static_cast<std::int64_t>(1e6 * wait_s);
    const std::int64_t until_us = began_us + static_cast<std::int64_t>(1e6 * patience_s);
    if (!result.retry || stop_ || steady_clock_us() + wait_us > until_us) return false;
    wake_.wait_for(lock, std::chrono::microseconds(wait_us), [this] { return stop_; });
    settings = settings_;  // a reload may have corrected them
    patience_s = patience_s_;
  }
}

}  // namespace framewatch::daemon
