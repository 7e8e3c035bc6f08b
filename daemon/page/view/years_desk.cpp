// SPDX-License-Identifier: MIT
#include "daemon/page/view/years_desk.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <utility>

#include "daemon/base/clocks.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_points.h"
#include "drivers/files/caught.h"

namespace framewatch::daemon {
namespace {

constexpr unsigned kNoHistory = 503;  // HTTP
constexpr std::int64_t kTryAgain_us = 60 * kSecond_us;

LossFollower learner_of(Quantity quantity, const Config& config) {
  LossFollower out = follower_of(quantity, config);
  out.keep_weather();
  return out;
}

/// Adds the elements of `more`, which was learned from the same days.
void join(WeatherEffects more, WeatherEffects& effects) {
  if (effects.empty())
    effects = std::move(more);
  else if (more.covariates == effects.covariates)
    effects.by_element.merge(more.by_element);
}

}  // namespace

WeatherLearner::WeatherLearner(const Config& config)
    : config_(config),
      followers_{learner_of(Quantity::stiffness, config), learner_of(Quantity::damping, config)},
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

WeatherModel WeatherLearner::model(std::int64_t end_us) {
  const std::int64_t day = floor_day(end_us);
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool again = model_.state == WeatherModel::State::failed &&
                     steady_clock_us() - tried_at_us_ > kTryAgain_us;
  if (day != asked_day_ || again) {
    asked_day_ = day;
    wanted_day_ = day;
    model_.state = WeatherModel::State::fitting;
    wake_.notify_all();
  }
  return model_;
}

void WeatherLearner::work(const std::stop_token& stop) {
  // A long computation, which may wait for others. At an idle priority it would never end on a busy
  // machine.
  const sched_param batch{};
  ::pthread_setschedparam(::pthread_self(), SCHED_BATCH, &batch);
  while (!stop.stop_requested()) {
    std::int64_t day = 0;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      wake_.wait(lock, stop, [this] { return wanted_day_.has_value(); });
      if (stop.stop_requested()) return;
      day = *std::exchange(wanted_day_, std::nullopt);
    }
    auto effects = std::make_shared<WeatherEffects>();
    std::string problem;
    const std::string thrown = drivers::caught([&] { problem = learn(day, stop, *effects); });
    if (!thrown.empty()) problem = thrown;
    const std::lock_guard<std::mutex> lock(mutex_);
    tried_at_us_ = steady_clock_us();
    if (wanted_day_) continue;
    model_.state = problem.empty() ? WeatherModel::State::ready : WeatherModel::State::failed;
    model_.problem = problem;
    if (problem.empty()) model_.effects = std::move(effects);
  }
}

/// Returns why it could not learn; empty if it could.
std::string WeatherLearner::learn(std::int64_t to_day, const std::stop_token& stop,
                                  WeatherEffects& out) {
  SummaryQuery summaries;
  if (std::string why = summaries.open(config_.history->directory); !why.empty()) return why;
  for (LossFollower& follower : followers_) {
    std::string problem;
    if (!follower.advance(
            summaries, to_day, [&stop] { return stop.stop_requested(); }, problem))
      return problem.empty() ? "stopped" : problem;
    join(follower.weather_effects(), out);
  }
  return {};
}

YearsDesk::YearsDesk(const Config& config)
    : config_(config),
      learner_(config),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

void YearsDesk::close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
  }
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  for (Asked& asked : std::exchange(waiting_, {}))
    asked.done({kNoHistory, "framewatch serve ends"});
}

bool YearsDesk::ask(YearsRequest request, Done done) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (closed_ || waiting_.size() == kMost) return false;
  waiting_.push_back({std::move(request), std::move(done)});
  wake_.notify_one();
  return true;
}

void YearsDesk::work(const std::stop_token& stop) {
  for (;;) {
    Asked asked;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      wake_.wait(lock, stop, [this] { return !waiting_.empty(); });
      if (stop.stop_requested()) return;
      asked = std::move(waiting_.front());
      waiting_.pop_front();
    }
    YearsAnswer out;
    const std::string thrown = drivers::caught([&] { out = answer(asked.request); });
    if (!thrown.empty()) out = {kNoHistory, "the history cannot be read: " + thrown};
    asked.done(std::move(out));
  }
}

YearsAnswer YearsDesk::answer(const YearsRequest& request) {
  SummaryQuery summaries;
  if (const std::string why = summaries.open(config_.history->directory); !why.empty())
    return {kNoHistory, "the history cannot be read: " + why};
  const std::optional<HistoryExtent> all = history_extent(summaries);
  return answer_years(request, summaries, all, all ? learner_.model(all->end_us) : WeatherModel());
}

}  // namespace framewatch::daemon
