// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/loss_follower.h"

#include <algorithm>
#include <utility>

#include "daemon/base/clocks.h"
#include "daemon/monitor/events/change_words.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_losses.h"
#include "estimator/years/damping_days.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kStart_d = 30, kYear_d = 365;
constexpr int kMostSkipped = 100;
constexpr std::int64_t kChunk_d = 180;  // days in memory at once

std::vector<std::string> names_of(const std::vector<WeatherSpan>& spans) {
  std::vector<std::string> out;
  for (const WeatherSpan& s : spans) out.push_back(s.name);
  return out;
}

std::int64_t period_s_of(const HistorySettings& s) {
  const bool hours = std::ranges::find(s.summary_s, kHour_s) != s.summary_s.end();
  return hours ? kHour_s : s.summary_s.back();
}

}  // namespace

std::optional<std::int64_t> first_summary(SummaryQuery& summaries, std::int64_t period_s) {
  auto first = summaries.first_us(period_s, -kEver_us);
  for (int skipped = 0; first && skipped < kMostSkipped; ++skipped) {
    const auto next = summaries.first_us(period_s, *first + kDay_us);
    if (!next || *next - *first < kYear_d * kDay_us) break;
    first = next;
  }
  return first;
}

std::vector<WeatherSpan> lasting_covariates(const std::vector<WeatherSpan>& spans,
                                            std::int64_t first_day, std::int64_t to_day) {
  const std::int64_t late_d = std::max(kStart_d, (to_day - first_day) / 4);
  std::vector<WeatherSpan> out = spans;
  std::erase_if(out, [&](const WeatherSpan& s) {
    return s.first_us >= (first_day + late_d) * kDay_us || s.last_us < (to_day - kYear_d) * kDay_us;
  });
  return out;
}

WeatherTable kept_weather(const HistoryRequest& r, SummaryQuery& summaries,
                          const std::vector<ElementDays>& elements) {
  std::int64_t first = INT64_MAX, last = INT64_MIN;
  for (const ElementDays& e : elements) {
    first = std::min(first, e.days.begin()->first);
    last = std::max(last, e.days.rbegin()->first);
  }
  if (elements.empty()) return {};
  std::vector<WeatherSpan> spans = summaries.weather_spans();
  for (WeatherSpan& s : spans) {  // readings before --from do not count
    s.first_us = std::max(s.first_us, r.from_us);
    s.last_us = std::min(s.last_us, r.to_us);
  }
  std::vector<std::string> names;
  for (const WeatherSpan& s : lasting_covariates(spans, first, last + 1)) names.push_back(s.name);
  return weather_of(summaries.weather(first * kDay_us, r.to_us), names);
}

LossFollower::LossFollower(Quantity quantity, const estimator::LifeBudget& budget, double window_s,
                           std::int64_t period_s)
    : quantity_(quantity), budget_(budget), window_s_(window_s), period_s_(period_s) {}

/// Looks up what there is to watch. Begins with the first day if that has changed. Returns false if
/// there is nothing to watch.
bool LossFollower::begin(SummaryQuery& summaries, std::int64_t to_day) {
  const auto first_us = first_summary(summaries, period_s_);
  if (!first_us) return false;
  const std::int64_t first_day = floor_day(*first_us);
  std::vector<SummaryParameter> elements = summaries.parameters();
  std::erase_if(elements, [&](const SummaryParameter& p) {
    return !is_of_frame(quantity_, p.name) || !summaries.newest_row(p.id, period_s_);
  });
  std::vector<std::string> covariates =
      names_of(lasting_covariates(summaries.weather_spans(), first_day, to_day));
  std::vector<std::int64_t> maintenance_days = summaries.maintenance_days();
  const auto taken = [this](std::vector<std::int64_t> days) {
    std::erase_if(days, [this](std::int64_t day) { return day >= next_day_; });
    return days;
  };
  const bool same =
      watch_ && covariates == covariates_ && taken(maintenance_days) == taken(maintenance_days_) &&
      std::ranges::equal(elements, elements_, {}, &SummaryParameter::id, &SummaryParameter::id);
  // A clock that was ahead may have led beyond the present day.
  if (!same || to_day + 1 < next_day_) {
    watch_.reset();
    weather_.clear();
    elements_ = std::move(elements);
    covariates_ = std::move(covariates);
    next_day_ = first_day;
  }
  maintenance_days_ = std::move(maintenance_days);
  if (elements_.empty()) return false;
  if (!watch_) watch_.emplace(elements_.size(), covariates_of(covariates_), budget_);
  return true;
}

/// Takes these days. If `stop` returns true, next_day_ stays.
void LossFollower::take(SummaryQuery& summaries, std::int64_t from_day, std::int64_t to_day,
                        const std::function<bool()>& stop, std::vector<Loss>& found) {
  const std::int64_t from_us = from_day * kDay_us, to_us = to_day * kDay_us;
  std::vector<ElementDays> elements;
  for (const SummaryParameter& p : elements_) {
    if (stop()) return;
    elements.push_back(element_days(p, summaries, period_s_, window_s_, from_us, to_us));
  }
  const WeatherTable weather = weather_of(summaries.weather(from_us, to_us), covariates_);
  for (std::int64_t day = from_day; day < to_day; ++day) {
    if (stop()) return;
    std::vector<estimator::DayValue> values;
    for (const ElementDays& e : elements) values.push_back(watched(quantity_, e.value(day)));
    if (begins_anew(maintenance_days_, day)) watch_->begin_anew();
    const auto loss = watch_->push(static_cast<double>(day), values, weather.of(day));
    if (keeps_weather_)
      if (Eigen::VectorXd regressors = watch_->regressors(); regressors.size() > 0)
        weather_[day] = std::move(regressors);
    if (loss)
      found.push_back({loss->element == estimator::YearsWatch::kAllAlike
                           ? kWholeBuilding
                           : elements_[static_cast<std::size_t>(loss->element)].name,
                       in_quantity(quantity_, *loss)});
  }
  next_day_ = to_day;
}

std::optional<std::vector<LossFollower::Loss>> LossFollower::advance(
    SummaryQuery& summaries, std::int64_t to_day, const std::function<bool()>& stop,
    std::string& problem) {
  std::vector<Loss> out;
  if (!begin(summaries, to_day)) {
    problem = summaries.problem();
    return problem.empty() ? std::optional(out) : std::nullopt;
  }
  while (next_day_ < to_day && summaries.problem().empty() && !stop()) {
    take(summaries, next_day_, std::min(next_day_ + kChunk_d, to_day), stop, out);
  }
  problem = summaries.problem();
  if (problem.empty() && next_day_ >= to_day) return out;
  watch_.reset();
  weather_.clear();
  return std::nullopt;
}

WeatherEffects LossFollower::weather_effects() const {
  WeatherEffects out;
  if (!watch_ || watch_->days() == 0) return out;
  out.covariates = covariates_;
  out.weather = weather_;
  for (std::size_t p = 0; p < elements_.size(); ++p)
    out.by_element[elements_[p].name] =
        watch_->weather_effect(p) *
        (quantity_ == Quantity::damping ? -estimator::kDampingPower : 1);
  out.find_mean();
  return out;
}

LossFollower follower_of(Quantity quantity, const Config& config) {
  return {quantity, config.watch ? config.watch->life : estimator::LifeBudget(),
          config.pipeline.options.window_s, period_s_of(*config.history)};
}

}  // namespace framewatch::daemon
