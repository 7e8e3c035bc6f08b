// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/loss_monitor.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/numbers.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/history/history_days.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_losses.h"
#include "drivers/files/caught.h"

namespace framewatch::daemon {
namespace {

constexpr std::array kKinds = {"lasting_loss", "lasting_damping"};  ///< by Quantity
constexpr std::array kQuantities = {Quantity::stiffness, Quantity::damping};
constexpr std::int64_t kMostKnown = 10000;
constexpr std::chrono::minutes kTryAgain{10};

std::int64_t day_us(double day) {
  return static_cast<std::int64_t>(day) * kDay_us;
}

/// Returns a number for a place, so that losses of one day have different ids.
std::int64_t place_number(const std::string& place) {
  std::uint64_t hash = 1469598103934665603u;
  for (const char c : place) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return static_cast<std::int64_t>(hash % 1'000'000'000);
}

}  // namespace

event_t loss_event(Quantity quantity, const LossFollower::Loss& loss,
                   const estimator::LifeBudget& budget, const FrameLabels& labels) {
  const estimator::YearsWatch::Finding& f = loss.finding;
  const bool all = loss.element == kWholeBuilding;
  event_t e{};
  e.since_us = day_us(f.since_day);
  e.time_us = day_us(f.found_day) + kDay_us;
  e.id = day_us(f.found_day) + 1'000'000 + place_number(loss.element);
  e.state = event_state::raised;
  e.severity = quantity == Quantity::stiffness ? severity::alarm : severity::warning;
  e.kind = kKinds[static_cast<std::size_t>(quantity)];
  e.place = loss.element;
  e.value = 100 * f.ratio;
  e.std_error = 100 * f.std_error;
  e.unit = "%";
  if (quantity == Quantity::damping) {
    e.message = fmt::format(
        "the damping of {} grew by {}, give or take {}, since {}, and weather does not explain it. "
        "Beside a loss of stiffness there it is a second sign of damage; alone it may be friction",
        all ? "all frames" : named_place(loss.element, labels), percent_words(f.ratio, f.std_error),
        percent(f.std_error), day_text(static_cast<std::int64_t>(f.since_day)));
    return e;
  }
  e.message =
      fmt::format("{}, and weather does not explain it. {}Chance of a false one in {:g} years: {}",
                  loss_words(loss.element, f, labels),
                  all ? "It may also be a mass, or weather that is not measured. " : "",
                  budget.years, probability_text(budget.probability));
  return e;
}

LossMonitor::LossMonitor(const Config& config)
    : config_(config),
      labels_(frame_labels(config.pipeline.structure)),
      followers_{follower_of(Quantity::stiffness, config), follower_of(Quantity::damping, config)},
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

LossMonitor::News LossMonitor::update(std::int64_t stored_us) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stored_us > -kEver_us) {
    const std::int64_t day = floor_day(stored_us - kMargin_us);
    if (day != asked_day_) {
      asked_day_ = day;
      wanted_day_ = day;
      wake_.notify_all();
    }
  }
  return std::exchange(news_, {});
}

void LossMonitor::put(News news) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (event_t& e : news.events) news_.events.push_back(std::move(e));
  if (!news.before.all().empty()) news_.before = std::move(news.before);
  news_.problem = std::move(news.problem);
}

void LossMonitor::work(const std::stop_token& stop) {
  (void)drivers::caught([this] {  // look() tries it again
    SummaryQuery summaries;
    News news;
    if (summaries.open(config_.history->directory).empty()) read_known(summaries, news);
    put(std::move(news));
  });
  std::optional<std::int64_t> again;
  while (!stop.stop_requested()) {
    std::int64_t day = 0;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      const auto asked = [this] { return wanted_day_.has_value(); };
      if (again)
        wake_.wait_for(lock, stop, kTryAgain, asked);
      else
        wake_.wait(lock, stop, asked);
      if (stop.stop_requested() || (!wanted_day_ && !again)) continue;
      day = wanted_day_ ? *wanted_day_ : *again;
      wanted_day_.reset();
    }
    News news;
    const std::string thrown = drivers::caught([&] { look(day, stop, news); });
    if (!thrown.empty()) news.problem = thrown;
    again = news.problem.empty() ? std::nullopt : std::optional(day);
    put(std::move(news));
  }
}

bool LossMonitor::is_known(const event_t& event) const {
  return std::ranges::any_of(known_, [&](const event_t& k) {
    return k.kind == event.kind && k.place == event.place &&
           std::abs(k.since_us - event.since_us) <= kSame_d * kDay_us;
  });
}

void LossMonitor::read_known(SummaryQuery& summaries, News& news) {
  if (read_known_) return;
  known_.clear();
  for (const char* kind : kKinds)
    for (event_t& e : summaries.events_of(kind, kMostKnown)) known_.push_back(std::move(e));
  for (const event_t& e : known_) news.before.note(e);
  for (const StoredAcknowledgement& a : summaries.acknowledgements(-kEver_us, kEver_us))
    if (std::ranges::find(kKinds, a.kind) != kKinds.end())
      news.before.acknowledge(a.id, {a.time_us, a.who, a.comment});
  read_known_ = summaries.problem().empty();
}

void LossMonitor::look(std::int64_t to_day, const std::stop_token& stop, News& news) {
  SummaryQuery summaries;
  news.problem = summaries.open(config_.history->directory);
  if (!news.problem.empty()) return;
  read_known(summaries, news);
  for (const Quantity quantity : kQuantities) {
    const auto losses = followers_[static_cast<std::size_t>(quantity)].advance(
        summaries, to_day, [&stop] { return stop.stop_requested(); }, news.problem);
    if (!losses) return;
    for (const LossFollower::Loss& loss : *losses) {
      event_t event = loss_event(quantity, loss, config_.watch->life, labels_);
      if (is_known(event)) continue;
      known_.push_back(event);
      news.events.push_back(std::move(event));
    }
  }
}

}  // namespace framewatch::daemon
