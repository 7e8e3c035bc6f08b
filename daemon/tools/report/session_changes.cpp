// SPDX-License-Identifier: MIT
#include "daemon/tools/report/session_changes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <fmt/core.h>

#include "daemon/monitor/estimates/parameter_summary.h"
#include "daemon/monitor/events/event_messages.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/watch/watch.h"

namespace framewatch::daemon {
namespace {

using estimator::WindowValue;

constexpr double kTimeStep_s = 0.1;
constexpr int kFewestWindows = 4;
constexpr double kTemperatureErrors = 3;    // of a slope, attributed to temperature
constexpr double kMaxByTemperature = 0.05;  // beyond it no stiffness is judged
/// Factor by which a loss in one story may be larger than its group's value shows.
constexpr double kGroupShows = 1.5;

bool is_stiffness(const SessionEstimates& s, std::size_t p) {
  return s.table.kind[p] <= static_cast<int>(estimator::ParameterKind::panel_stiffness);
}

double least_change(const SessionEstimates& s, std::size_t p) {
  const estimator::WatchOptions usual;
  return s.table.kind[p] == static_cast<int>(estimator::ParameterKind::frame_stiffness)
             ? usual.least_change_k
             : usual.least_change_g;
}

/// Returns the time of a change. A window whose share x lies after the change has the share x of
/// the change; the time is the one whose windows fit best.
std::int64_t moment(const SessionEstimates& s, const ElementChange& c, std::int64_t from_us,
                    std::int64_t to_us) {
  double best = INFINITY;
  std::int64_t at_us = from_us;
  const auto step_us = static_cast<std::int64_t>(1e6 * kTimeStep_s);
  for (std::int64_t t = from_us; t <= to_us; t += step_us) {
    double loss = 0;
    for (std::size_t w = 0; w < s.windows(); ++w) {
      const double value = s.value[c.parameter][w];
      if (s.end_us[w] < from_us || s.start_us[w] > to_us || !std::isfinite(value)) continue;
      const auto length = static_cast<double>(s.end_us[w] - s.start_us[w]);
      const double behind = std::clamp(static_cast<double>(s.end_us[w] - t) / length, 0.0, 1.0);
      const double expected = c.before.value + behind * (c.after.value - c.before.value);
      loss += std::pow((value - expected) / s.std_error[c.parameter][w], 2);
    }
    if (loss < best) {
      best = loss;
      at_us = t;
    }
  }
  return at_us;
}

/// Appends the changes of a stretch of windows: divides it at the largest, then each part.
void divide(const SessionEstimates& s, std::size_t p, const std::vector<WindowValue>& values,
            std::vector<ElementChange>& out) {
  const auto found = estimator::find_change(values, least_change(s, p));
  if (!found) return;
  const auto at = [&](std::size_t i) { return values.begin() + static_cast<std::ptrdiff_t>(i); };
  divide(s, p, {values.begin(), at(found->before_end)}, out);
  ElementChange c{p, 0, found->before, found->after, found->ratio(), found->std_error()};
  c.since_us = moment(s, c, to_microseconds(values[found->before_end - 1].end),
                      to_microseconds(values[found->after_begin].start));
  out.push_back(c);
  divide(s, p, {at(found->after_begin), values.end()}, out);
}

/// Returns the newest event of an element's change; nullptr when none is raised at the end.
const event_t* record_of(const SessionEstimates& s, const std::string& place) {
  const event_t* last = nullptr;
  for (const event_t& e : s.events)
    if (e.kind == "stiffness_change" && e.place == place) last = &e;
  return last == nullptr || last->state == event_state::cleared ? nullptr : last;
}

/// Replaces the changes of stiffnesses that [watch] compared by those of its events, so that a
/// change has one size everywhere.
void take_records(const SessionEstimates& s, std::vector<ElementChange>& out) {
  for (std::size_t p = 0; p < s.parameters(); ++p) {
    const event_t* record = record_of(s, s.table.name[p]);
    ElementChange announced{p, 0, {}, {}, 0, 0, true};
    if (record != nullptr)
      for (const ElementChange& c : out)
        if (c.parameter == p && (c.ratio < 0) == (record->value < 0)) announced = c;
    if (record != nullptr || s.compared(p))
      std::erase_if(out, [&](const ElementChange& c) { return c.parameter == p; });
    if (record == nullptr) continue;
    announced.announced = true;
    announced.since_us = record->since_us;
    announced.ratio = record->value / 100;
    announced.std_error = record->std_error / 100;
    out.push_back(announced);
  }
}

/// Returns the relative deviation that the temperature may explain and that would not have shown.
double by_temperature(const SessionEstimates& s, std::size_t p) {
  if (!s.watch || p >= s.watch->per_degc.size()) return 0;
  const watch_t& w = *s.watch;
  const double off = std::abs(w.temperature_degc - w.baseline_degc[p]);
  if (!std::isfinite(off)) return 0;
  const double slope = std::isfinite(w.per_degc[p]) ? w.per_degc_std_error[p]
                                                    : estimator::DependenceLearner::kUsualPerDegc;
  return kTemperatureErrors * slope * off;
}

/// Returns the median relative standard error of the windows within two times.
double usual_error(const SessionEstimates& s, std::size_t p, std::int64_t from_us,
                   std::int64_t to_us) {
  const std::vector<std::uint8_t> settled = settled_windows(s, p);
  std::vector<double> errors;
  for (std::size_t w = 0; w < s.windows(); ++w)
    if (settled[w] != 0 && s.start_us[w] >= from_us && s.end_us[w] <= to_us)
      errors.push_back(s.std_error[p][w] / s.value[p][w]);
  return boxplot_of(std::move(errors)).median;
}

/// Returns the rms acceleration of the floors between two times, m/s^2.
double floor_motion_mps2(const SessionMotion& m, std::int64_t from_us, std::int64_t to_us) {
  const Eigen::Index from = m.row_at(from_us), to = m.row_at(to_us);
  double sum = 0, count = 0;
  for (std::size_t a = 0; a < m.axes.size(); ++a) {
    if (m.axes[a].story == 0 || !m.axes[a].horizontal()) continue;
    for (Eigen::Index row = from; row < to; ++row) {
      const double value = m.accel(row, static_cast<Eigen::Index>(a));
      if (!std::isfinite(value)) continue;
      sum += value * value;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : estimator::kNaN;
}

bool motion_died(const SessionEstimates& s, const SessionMotion* motion, const ElementChange& c) {
  constexpr double kWeaker = 0.5, kLargerErrors = 1.5;  // after over before
  const std::int64_t begin = s.start_us.front(), end = s.end_us.back();
  if (motion != nullptr)
    return floor_motion_mps2(*motion, c.since_us, end) <
           kWeaker * floor_motion_mps2(*motion, begin, c.since_us);
  return usual_error(s, c.parameter, c.since_us, end) >
         kLargerErrors * usual_error(s, c.parameter, begin, c.since_us);
}

bool is_recovery(const SessionEstimates& s, const SessionMotion* motion,
                 const std::vector<ElementChange>& all, const ElementChange& c) {
  if (!(c.ratio > 0) || !c.measured()) return false;
  const auto lost_before = [&](const ElementChange& other) {
    return other.parameter == c.parameter && other.ratio < 0 && other.measured() &&
           other.since_us < c.since_us &&
           c.after.value < (1 + least_change(s, c.parameter)) * other.before.value;
  };
  if (std::any_of(all.begin(), all.end(), lost_before)) return true;
  return motion_died(s, motion, c);
}

}  // namespace

std::vector<WindowValue> separate_windows(const SessionEstimates& s, std::size_t p) {
  std::vector<WindowValue> out;
  const std::vector<std::uint8_t> settled = settled_windows(s, p);
  std::int64_t end_us = 0;
  for (std::size_t w = 0; w < s.windows(); ++w) {
    if (settled[w] == 0 || !std::isfinite(s.value[p][w]) ||
        (!out.empty() && s.start_us[w] < end_us))
      continue;
    end_us = s.end_us[w];
    out.push_back({estimator::from_microseconds(s.start_us[w]),
                   estimator::from_microseconds(end_us), s.value[p][w], s.std_error[p][w]});
  }
  return out;
}

std::vector<ElementChange> take_recoveries(const SessionEstimates& s, const SessionMotion* motion,
                                           std::vector<ElementChange>& changes) {
  std::vector<ElementChange> recoveries, others;
  for (const ElementChange& c : changes)
    (is_recovery(s, motion, changes, c) ? recoveries : others).push_back(c);
  changes = std::move(others);
  return recoveries;
}

std::vector<ElementChange> session_changes(const SessionEstimates& s) {
  std::vector<ElementChange> out;
  for (std::size_t p = 0; p < s.parameters(); ++p)
    if (is_stiffness(s, p)) divide(s, p, separate_windows(s, p), out);
  take_records(s, out);
  std::stable_sort(out.begin(), out.end(), [](const ElementChange& a, const ElementChange& b) {
    return a.since_us < b.since_us;
  });
  return out;
}

estimator::Parameter parameter_of(const parameter_table_t& t, std::size_t p) {
  estimator::Parameter out{};
  out.name = t.name[p];
  out.kind = static_cast<estimator::ParameterKind>(t.kind[p]);
  out.story = out.last_story = t.story[p];
  const std::string& n = t.name[p];
  if (const std::size_t to = n.find("to"); to != std::string::npos)
    out.last_story = std::max(out.story, std::atoi(n.c_str() + to + 2));
  return out;
}

std::string of_one_story(const parameter_table_t& table, const ElementChange& c) {
  const estimator::Parameter p = parameter_of(table, c.parameter);
  if (p.last_story == p.story || !(c.ratio < 0)) return "";
  const double most = std::min(2 * c.std_error - c.ratio, 1.0);
  return fmt::format(" (one of stories {} to {} may have lost up to {:.0f} %)", p.story,
                     p.last_story, 100 * loss_of_one_story(p, most));
}

const event_t* common_change(const SessionEstimates& s) {
  return record_of(s, kWholeBuilding);
}

std::vector<JudgedElement> judged_elements(const SessionEstimates& s) {
  std::vector<JudgedElement> out;
  for (std::size_t p = 0; p < s.parameters(); ++p) {
    if (!is_stiffness(s, p)) continue;
    const std::vector<WindowValue> values = separate_windows(s, p);
    if (values.size() < kFewestWindows) continue;
    const estimator::WindowMean mean = estimator::mean_of(values, 0, values.size());
    // The error of the difference between two halves.
    const double errors = 2 * estimator::kChangeErrors * mean.std_error / mean.value;
    const double least = least_change(s, p), temperature = by_temperature(s, p);
    if (!(errors < 2 * least) || temperature > kMaxByTemperature) continue;
    const estimator::Parameter parameter = parameter_of(s.table, p);
    const bool group = parameter.last_story > parameter.story;
    const double shows = (std::max(least, errors) + temperature) * (group ? kGroupShows : 1);
    out.push_back({p, loss_of_one_story(parameter, std::min(shows, 1.0))});
  }
  return out;
}

std::string why_not_judged(const SessionEstimates& s) {
  std::size_t hidden = 0;
  for (std::size_t p = 0; p < s.parameters(); ++p)
    if (is_stiffness(s, p) && by_temperature(s, p) > kMaxByTemperature) ++hidden;
  return hidden == 0 ? ""
                     : fmt::format(
                           "{} stiffnesses are not judged: the building's temperature differs from "
                           "its baseline's, and their dependence on it is not learned yet. ",
                           hidden);
}

std::string element_words(const parameter_table_t& table, std::size_t p,
                          const FrameLabels& labels) {
  const std::string& name = table.name[p];
  const bool stiffness =
      table.kind[p] == static_cast<int>(estimator::ParameterKind::frame_stiffness) ||
      table.kind[p] == static_cast<int>(estimator::ParameterKind::panel_stiffness);
  return stiffness ? element_words(name, labels) : name;
}

}  // namespace framewatch::daemon
