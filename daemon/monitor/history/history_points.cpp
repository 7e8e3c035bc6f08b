// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history_points.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/numbers.h"
#include "daemon/monitor/estimates/summary_intake.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/loss_follower.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

using estimator::kNaN;

constexpr std::int64_t kDay_s = 86'400;
constexpr std::int64_t kSteps_s[] = {60,         600,         kHour_s,     kDay_s,
                                     7 * kDay_s, 28 * kDay_s, 364 * kDay_s};

/// The summaries of one step.
struct Step {
  std::vector<double> q1, median, q3;
  double shown_s = 0;

  void clear() {
    q1.clear();
    median.clear();
    q3.clear();
    shown_s = 0;
  }
};

/// Returns the part of a step that the history can cover: within the span, before its newest
/// summary ends.
double length_s(const HistorySpan& span, std::size_t point) {
  const std::int64_t start = std::max(span.start_us(point), span.from_us);
  const std::int64_t end = std::min(span.start_us(point + 1), span.end_us);
  return static_cast<double>(end - start) / static_cast<double>(kSecond_us);
}

}  // namespace

std::optional<HistoryExtent> history_extent(SummaryQuery& summaries) {
  std::optional<HistoryExtent> out;
  std::int64_t newest_us = INT64_MIN;
  for (const std::int64_t period_s : summaries.period_lengths()) {
    const auto first = first_summary(summaries, period_s);
    const auto last = summaries.last_us(period_s, kEver_us);
    if (!first || !last) continue;
    if (!out) out = {*first, *last};
    out->first_us = std::min(out->first_us, *first);
    if (*last <= newest_us) continue;  // of two that begin together, the shorter one ends first
    newest_us = *last;
    out->end_us = *last + period_s * kSecond_us;
  }
  return out;
}

std::size_t HistorySpan::points() const {
  return to_us > from_us ? at(to_us - 1) + 1 : 0;
}

std::int64_t HistorySpan::start_us(std::size_t point) const {
  return floor_to(from_us, step_s * kSecond_us) +
         static_cast<std::int64_t>(point) * step_s * kSecond_us;
}

std::size_t HistorySpan::at(std::int64_t time_us) const {
  return static_cast<std::size_t>((time_us - start_us(0)) / (step_s * kSecond_us));
}

std::int64_t least_step_s(std::int64_t from_us, std::int64_t to_us) {
  for (const std::int64_t step_s : kSteps_s)
    if (HistorySpan{from_us, to_us, step_s, step_s, to_us}.points() <= HistorySpan::kMostPoints)
      return step_s;
  // Whole years from here on.
  std::int64_t step_s = kSteps_s[std::size(kSteps_s) - 1];
  while (HistorySpan{from_us, to_us, step_s, step_s, to_us}.points() > HistorySpan::kMostPoints)
    step_s *= 2;
  return step_s;
}

std::optional<HistorySpan> choose_span(SummaryQuery& summaries, std::int64_t from_us,
                                       std::int64_t to_us, std::string& problem) {
  HistorySpan out{from_us, to_us, 0, least_step_s(from_us, to_us), to_us};
  struct Stored {
    std::int64_t period_s, first_us;
  };
  std::vector<Stored> stored;
  std::int64_t begun_us = INT64_MAX;
  for (const std::int64_t period_s : summaries.period_lengths())
    if (const auto first = summaries.first_us(period_s, from_us); first && *first < to_us) {
      stored.push_back({period_s, *first});
      begun_us = std::min(begun_us, *first);
    }
  // Short summaries are deleted after a while: those that miss the beginning do not count.
  for (const auto& [period_s, first_us] : stored)
    if ((out.period_s == 0 || period_s <= out.step_s) &&
        first_us <= begun_us + stored.back().period_s * kSecond_us)
      out.period_s = period_s;
  if (out.period_s == 0) return out;
  out.step_s = std::max(out.step_s, out.period_s);
  if ((to_us - from_us) / kSecond_us / out.period_s > HistorySpan::kMostPeriods) {
    problem = fmt::format(
        "the span is too long for its summaries of {} s: ask for at most {:.0f} days at once",
        out.period_s, static_cast<double>(HistorySpan::kMostPeriods * out.period_s) / kDay_s);
    return std::nullopt;
  }
  if (const auto last = summaries.last_us(out.period_s, to_us))
    out.end_us = std::min(to_us, *last + out.period_s * kSecond_us);
  return out;
}

ElementPoints element_points(const SummaryParameter& parameter, SummaryQuery& summaries,
                             const HistorySpan& span) {
  const std::size_t n = span.points();
  ElementPoints out{std::vector<double>(n, kNaN), std::vector<double>(n, kNaN),
                    std::vector<double>(n, kNaN), std::vector<double>(n, kNaN)};
  if (span.period_s == 0) return out;
  Step step;
  std::size_t point = 0;
  bool any = false;
  const auto finish = [&] {
    if (!any) return;
    if (!step.median.empty()) {
      out.q1[point] = median(std::move(step.q1));
      out.median[point] = median(std::move(step.median));
      out.q3[point] = median(std::move(step.q3));
    }
    out.covered[point] = std::min(1.0, step.shown_s / std::max(length_s(span, point), 1e-3));
    step.clear();
  };
  summaries.visit_rows(
      parameter.id, span.period_s, span.from_us, span.to_us, [&](const SummaryRow& row) {
        if (const std::size_t now = span.at(row.start_us); !any || now != point) {
          finish();
          point = now;
          any = true;
        }
        if (row.observable <= 0 || row.windows <= 0) return;
        step.shown_s += static_cast<double>(span.period_s) * static_cast<double>(row.observable) /
                        static_cast<double>(row.windows);
        if (row.boxed <= 0) return;
        step.q1.push_back(row.q1);
        step.median.push_back(row.median);
        step.q3.push_back(row.q3);
      });
  finish();
  // Time without summaries is time without values.
  for (std::size_t p = 0; p < n; ++p)
    if (std::isnan(out.covered[p]) && span.start_us(p) < span.end_us) out.covered[p] = 0;
  return out;
}

std::vector<double> corrected_points(const std::string& element, const ElementPoints& points,
                                     const HistorySpan& span, const WeatherEffects& effects) {
  std::vector<double> out(points.median.size(), kNaN);
  for (std::size_t p = 0; p < out.size(); ++p)
    if (std::isfinite(points.median[p]))
      out[p] = points.median[p] *
               std::exp(-effects.over(element, span.start_us(p), span.start_us(p + 1)));
  return out;
}

std::vector<WeatherPoints> weather_points(SummaryQuery& summaries, const HistorySpan& span) {
  std::vector<WeatherPoints> out;
  const std::size_t n = span.points();
  const std::int64_t step_us = span.step_s * kSecond_us, hour_us = kHour_s * kSecond_us;
  const std::int64_t from_us = floor_to(span.from_us, hour_us);
  for (const WeatherSpan& kept : summaries.weather_spans()) {
    WeatherPoints w{kept.name, std::vector<double>(n, kNaN), std::vector<double>(n, kNaN),
                    std::vector<double>(n, kNaN)};
    std::vector<int> hours(n, 0);
    bool any = false;
    summaries.visit_weather(kept.name, from_us, span.to_us, [&](const WeatherHour& hour) {
      if (!std::isfinite(hour.mean)) return;
      const std::int64_t end_us = std::min(span.to_us, hour.start_us + hour_us);
      for (std::int64_t t = std::max(hour.start_us, span.from_us); t < end_us;
           t += std::min(step_us, hour_us)) {
        const std::size_t p = span.at(t);
        any = true;
        if (hours[p]++ == 0) {
          w.mean[p] = hour.mean;
          w.min[p] = hour.min;
          w.max[p] = hour.max;
          continue;
        }
        w.mean[p] += (hour.mean - w.mean[p]) / hours[p];
        w.min[p] = std::min(w.min[p], hour.min);
        w.max[p] = std::max(w.max[p], hour.max);
      }
    });
    if (any) out.push_back(std::move(w));
  }
  return out;
}

}  // namespace framewatch::daemon
