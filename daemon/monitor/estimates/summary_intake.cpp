// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimates/summary_intake.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "daemon/base/clocks.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kStatusIsEarly_us = 2'000'000;  // a window comes after its last sample
constexpr double kBoxesPerWindow = 10;
constexpr std::size_t kMaxTaken = 4096;

using Counts = std::vector<std::int64_t>;

std::array<const Counts*, ChannelData::kCounts> counts_of(const status_t& s) {
  return {&s.received, &s.lost, &s.late, &s.repaired, &s.rejected, &s.stuck, &s.clipped};
}

}  // namespace

std::int64_t floor_to(std::int64_t time_us, std::int64_t step_us) {
  const std::int64_t rest = time_us % step_us;
  return time_us - (rest < 0 ? rest + step_us : rest);
}

std::int64_t PeriodCollector::slot(std::int64_t time_us) const {
  return floor_to(time_us, period_us_);
}

bool PeriodCollector::ends_before(const window_estimate_t& e) const {
  return !empty() && slot(e.window_end_us) != data_.start_us;
}

bool PeriodCollector::ends_before(const status_t& s) const {
  return !empty() &&
         (slot(s.time_us - kStatusIsEarly_us) > data_.start_us || s.name != status_.name);
}

bool PeriodCollector::ends_before(const parameter_table_t& table) const {
  return !empty() && (table.name != table_.name || table.unit != table_.unit);
}

void PeriodCollector::add(const parameter_table_t& table) {
  if (table.name != table_.name || table.unit != table_.unit) {
    data_.parameters.clear();
    late_.clear();
  }
  table_ = table;
}

void PeriodCollector::add(const window_estimate_t& e) {
  if (table_.name.empty() || e.value.size() != table_.name.size()) return;
  const std::int64_t start_us = slot(e.window_end_us);
  if (const auto before = taken_.find(start_us);
      before != taken_.end() && e.window_end_us <= before->second)
    return;
  if (data_.windows == 0) data_.start_us = start_us;
  ++data_.windows;
  data_.last_us = std::max(data_.last_us, e.window_end_us);
  add_values(e, data_);
}

void PeriodCollector::add_late(const window_estimate_t& e) {
  if (table_.name.empty() || e.value.size() != table_.name.size()) return;
  const std::int64_t start_us = slot(e.window_end_us);
  if (data_.windows > 0 && start_us == data_.start_us) return add_values(e, data_);
  if (!taken_.contains(start_us)) return;
  PeriodData& late = late_[start_us];
  late.start_us = start_us;
  add_values(e, late);
}

void PeriodCollector::add_values(const window_estimate_t& e, PeriodData& to) {
  to.parameters.resize(e.value.size());
  const auto spacing_us = static_cast<std::int64_t>(
      std::max(1.0, 1e6 * table_.window_rows / std::max(table_.rate_hz, 1e-3) / kBoxesPerWindow));
  const bool boxed = std::exchange(box_slot_, floor_to(e.window_end_us, spacing_us)) != box_slot_;
  for (std::size_t p = 0; p < e.value.size(); ++p) {
    const double value = e.value[p];
    if (e.reason[p] != 0 || !std::isfinite(value)) continue;
    ParameterData& data = to.parameters[p];
    ++data.observable;
    data.sum += value;
    data.error_squares += e.std_error[p] * e.std_error[p];
    data.min = std::min(data.min, value);
    data.max = std::max(data.max, value);
    if (boxed) data.box.push_back(value);
  }
}

void PeriodCollector::add(const status_t& s) {
  const status_t before = std::exchange(status_, s);
  if (before.name != s.name) return;  // the first status: nothing to compare with
  if (empty()) data_.start_us = slot(s.time_us);
  data_.channels.resize(s.name.size());
  const auto now = counts_of(s), then = counts_of(before);
  for (std::size_t c = 0; c < s.name.size(); ++c) {
    for (std::size_t i = 0; i < now.size(); ++i) {
      const std::int64_t more = (*now[i])[c] - (*then[i])[c];
      data_.channels[c].counts[i] += more >= 0 ? more : (*now[i])[c];
    }
    data_.channels[c].noise = s.noise_mps2_per_rthz[c];
  }
}

PeriodData PeriodCollector::take() {
  if (data_.windows > 0) taken(data_.start_us, data_.last_us);
  return std::exchange(data_, {});
}

std::vector<PeriodData> PeriodCollector::take_late() {
  std::vector<PeriodData> out;
  for (auto& [start_us, data] : late_) out.push_back(std::move(data));
  late_.clear();
  return out;
}

void PeriodCollector::taken(std::int64_t start_us, std::int64_t last_us) {
  std::int64_t& known = taken_.try_emplace(start_us, last_us).first->second;
  known = std::max(known, last_us);
  if (taken_.size() > kMaxTaken) taken_.erase(taken_.begin());
}

SummaryIntake::SummaryIntake(const std::string& prefix, std::int64_t shortest_s,
                             std::function<void()> before_other_names)
    : kinds_{{prefix + "ESTIMATE", Kind::estimate}, {prefix + "ESTIMATE_LATE", Kind::late},
             {prefix + "PARAMETERS", Kind::table},  {prefix + "STATUS", Kind::status},
             {prefix + "EVENT", Kind::event},       {prefix + "ACKNOWLEDGED", Kind::acknowledged},
             {prefix + "WEATHER", Kind::weather}},
      before_other_names_(std::move(before_other_names)),
      collector_(kSecond_us * shortest_s) {}

std::optional<SummaryIntake::Kind> SummaryIntake::kind_of(const std::string& channel) const {
  const auto kind = kinds_.find(channel);
  return kind == kinds_.end() ? std::nullopt : std::optional(kind->second);
}

SummaryIntake::Taken SummaryIntake::take(Kind kind, std::span<const std::uint8_t> bytes) {
  Taken out;
  switch (kind) {
    case Kind::estimate:
      if (const auto e = drivers::decoded<window_estimate_t>(bytes)) {
        out.period = collector_.ends_before(*e) && end_period();
        collector_.add(*e);
        newest_us_ = std::max(newest_us_, e->window_end_us);
      }
      break;
    case Kind::late:
      if (const auto e = drivers::decoded<window_estimate_t>(bytes)) collector_.add_late(*e);
      break;
    case Kind::table:
      if (const auto t = drivers::decoded<parameter_table_t>(bytes)) {
        if (collector_.ends_before(*t)) {
          out.period = end_period();
          before_other_names_();
          batch_.periods.clear();
        }
        collector_.add(*t);
      }
      break;
    case Kind::status:
      if (const auto s = drivers::decoded<status_t>(bytes)) {
        out.period = collector_.ends_before(*s) && end_period();
        collector_.add(*s);
      }
      break;
    case Kind::event:
      if (auto e = drivers::decoded<event_t>(bytes)) {
        batch_.events.push_back(std::move(*e));
        out.news = true;
      }
      break;
    case Kind::acknowledged:
      if (auto a = drivers::decoded<acknowledged_t>(bytes)) {
        batch_.acknowledged.push_back(std::move(*a));
        out.news = true;
      }
      break;
    case Kind::weather:
      if (auto w = drivers::decoded<weather_status_t>(bytes))
        for (std::size_t c = 0; c < w->name.size(); ++c)
          if (std::isfinite(w->mean[c]))
            batch_.weather.push_back({std::move(w->name[c]), w->mean_us[c], w->mean[c]});
      break;
  }
  return out;
}

bool SummaryIntake::end_period() {
  std::vector<PeriodData> periods = collector_.take_late();
  if (!collector_.empty()) periods.push_back(collector_.take());
  if (periods.empty()) return false;
  batch_.parameters = collector_.parameters();
  batch_.channels = collector_.channels();
  std::move(periods.begin(), periods.end(), std::back_inserter(batch_.periods));
  return true;
}

}  // namespace framewatch::daemon
