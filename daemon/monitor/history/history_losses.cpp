// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history_losses.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/numbers.h"
#include "daemon/base/utc_time.h"
#include "estimator/numeric/nan.h"
#include "estimator/years/damping_days.h"

namespace framewatch::daemon {
namespace {

constexpr double kLikely = 0.3;  // evidence from which a loss is shown before it is proven
constexpr const char* kAll = "all alike";
constexpr double kSameTime_d = 30;  // between a loss of stiffness and a growth of damping

std::string change_text(double ratio, double std_error) {
  return fmt::format("{} %", change_with_error(ratio, std_error));
}

/// Returns the name of the element that a finding speaks of.
std::string element_name(const HistoryLosses& l, int element) {
  return element == estimator::YearsWatch::kAllAlike
             ? kAll
             : l.elements[static_cast<std::size_t>(element)];
}

}  // namespace

HistoryLosses find_losses(Quantity quantity, const std::vector<ElementDays>& elements,
                          const WeatherTable& weather, const estimator::LifeBudget& budget,
                          const std::vector<std::int64_t>& maintenance_days) {
  HistoryLosses out;
  out.quantity = quantity;
  out.budget = budget;
  for (const estimator::Covariate& c : weather.covariates) out.covariates.push_back(c.name);
  if (elements.empty()) return out;
  out.from_day = elements[0].days.begin()->first;
  out.to_day = elements[0].days.rbegin()->first;
  for (const ElementDays& e : elements) {
    out.elements.push_back(e.name);
    out.from_day = std::min(out.from_day, e.days.begin()->first);
    out.to_day = std::max(out.to_day, e.days.rbegin()->first);
  }
  for (const std::int64_t day : maintenance_days)
    if (day >= out.from_day && day <= out.to_day) out.maintenance_days.push_back(day);
  estimator::YearsWatch watch(elements.size(), weather.covariates, budget);
  for (std::int64_t day = out.from_day; day <= out.to_day; ++day) {
    std::vector<estimator::DayValue> values;
    for (const ElementDays& e : elements) values.push_back(watched(quantity, e.value(day)));
    if (begins_anew(maintenance_days, day)) watch.begin_anew();
    if (const auto loss = watch.push(static_cast<double>(day), values, weather.of(day)))
      out.found.push_back(in_quantity(quantity, *loss));
  }
  out.days = watch.days();
  out.wrong_sensor = watch.wrong_sensor();
  for (std::size_t p = 0; p < elements.size(); ++p) {
    const int element = static_cast<int>(p);
    out.state.push_back({elements[p].usual(), watch.evidence(element), watch.step(element)});
  }
  constexpr int kAllAlike = estimator::YearsWatch::kAllAlike;
  out.state.push_back({estimator::kNaN, watch.evidence(kAllAlike), watch.step(kAllAlike)});
  return out;
}

bool begins_anew(const std::vector<std::int64_t>& maintenance_days, std::int64_t day) {
  return std::ranges::any_of(maintenance_days, [day](std::int64_t changed) {
    return day == changed || day == changed + 1;
  });
}

std::string maintenance_sentence(const std::vector<std::int64_t>& days) {
  std::string out;
  for (const std::int64_t day : days) out += (out.empty() ? "" : ", ") + day_text(day);
  return out.empty()
             ? ""
             : "the building was changed on purpose on " + out + ": the search began anew there";
}

std::string wrong_sensor_sentence(const HistoryLosses& l) {
  if (!l.wrong_sensor) return "";
  const estimator::SensorSuspicions::Wrong& w = *l.wrong_sensor;
  const std::string& name = l.covariates[w.covariate];
  return fmt::format(
      "{} probably reads too {} since {}, by {}: what this explains does not count as a loss", name,
      w.size < 0 ? "low" : "high", day_text(static_cast<std::int64_t>(w.since_day)),
      with_error(std::abs(w.size), w.std_error));
}

std::string probability_text(double probability) {
  return fmt::format("{:.4g} %", 100 * probability);
}

std::string losses_sentence(const HistoryLosses& l) {
  return fmt::format(
      "{} of at least {} that weather does not explain; a false one in {:g} years has a "
      "probability of {}",
      l.found.empty()       ? "no loss"
      : l.found.size() == 1 ? "1 loss"
                            : fmt::format("{} losses", l.found.size()),
      probability_text(l.budget.least_loss), l.budget.years,
      probability_text(l.budget.probability));
}

std::string loss_sentence(const HistoryLosses& l, const estimator::YearsWatch::Finding& f) {
  return fmt::format("{} {}, since {}, found {}{}", element_name(l, f.element),
                     change_text(f.ratio, f.std_error),
                     day_text(static_cast<std::int64_t>(f.since_day)),
                     day_text(static_cast<std::int64_t>(f.found_day)),
                     f.element == estimator::YearsWatch::kAllAlike
                         ? ". A change of all frames may also be a mass, or weather that is not "
                           "measured"
                         : "");
}

std::string loss_words(const std::string& element, const estimator::YearsWatch::Finding& f,
                       const FrameLabels& labels) {
  const bool all = element == kWholeBuilding;
  return fmt::format("{} lost {} of {} stiffness, give or take {}, since {}",
                     all ? "all frames alike" : named_place(element, labels),
                     percent_words(std::abs(f.ratio), f.std_error), all ? "their" : "its",
                     percent(f.std_error), day_text(static_cast<std::int64_t>(f.since_day)));
}

std::vector<std::vector<std::string>> losses_rows(const HistoryLosses& l) {
  std::vector<std::vector<std::string>> out;
  for (std::size_t p = 0; p < l.state.size(); ++p) {
    const HistoryLosses::State& s = l.state[p];
    const bool all = p == l.elements.size();
    out.push_back({all ? kAll : l.elements[p], all ? "" : fmt::format("{:.5g}", s.median),
                   fmt::format("{:.0f} %", 100 * s.evidence),
                   s.evidence < kLikely
                       ? "no loss"
                       : change_text(std::expm1(s.step.size), s.step.std_error) + " since " +
                             day_text(static_cast<std::int64_t>(s.step.day))});
  }
  return out;
}

std::string losses_text(const HistoryLosses& l) {
  if (l.elements.empty()) return "no hour with a value of a frame's stiffness\n";
  std::string with;
  for (const std::string& name : l.covariates) with += (with.empty() ? "" : ", ") + name;
  std::string out =
      fmt::format("{} with values, {} to {}; weather: {}\n{}\n", days_text(l.days),
                  day_text(l.from_day), day_text(l.to_day),
                  with.empty() ? "not known, the season stands for it" : with, losses_sentence(l));
  for (const auto& f : l.found) out += "  " + loss_sentence(l, f) + "\n";
  if (!l.maintenance_days.empty()) out += maintenance_sentence(l.maintenance_days) + "\n";
  if (l.wrong_sensor) out += wrong_sensor_sentence(l) + "\n";
  out += fmt::format("\n{:<12} {:>12} {:>9}  {}\n", "element", "median, N/m", "evidence",
                     "most likely");
  for (const auto& row : losses_rows(l))
    out += fmt::format("{:<12} {:>12} {:>9}  {}\n", row[0], row[1], row[2], row[3]);
  return out;
}

std::vector<std::string> damping_sentences(const HistoryLosses& damping,
                                           const HistoryLosses& stiffness) {
  if (damping.elements.empty()) return {};
  const double least = std::pow(1 - damping.budget.least_loss, -estimator::kDampingPower) - 1;
  std::vector<std::string> out{
      fmt::format("Damping: {} of at least {:.0f} % that weather does not explain",
                  damping.found.empty()       ? "no growth"
                  : damping.found.size() == 1 ? "1 growth"
                                              : fmt::format("{} growths", damping.found.size()),
                  100 * least)};
  for (const auto& f : damping.found) {
    const std::string name = element_name(damping, f.element);
    const bool second = std::ranges::any_of(stiffness.found, [&](const auto& loss) {
      return std::abs(loss.since_day - f.since_day) <= kSameTime_d &&
             element_name(stiffness, loss.element).substr(1) == name.substr(1);
    });
    out.push_back(fmt::format(
        "{} {}, since {}, found {}: {}", name, change_text(f.ratio, f.std_error),
        day_text(static_cast<std::int64_t>(f.since_day)),
        day_text(static_cast<std::int64_t>(f.found_day)),
        second ? "a second sign of the loss there"
               : "friction may have grown there; no loss of stiffness is proven with it"));
  }
  return out;
}

std::string losses_json(const HistoryLosses& l, const HistoryLosses& damping) {
  using nlohmann::ordered_json;
  const auto findings = [](const HistoryLosses& of) {
    ordered_json out = ordered_json::array();
    for (const auto& f : of.found)
      out.push_back({{"parameter", element_name(of, f.element)},
                     {"ratio", f.ratio},
                     {"std_error", f.std_error},
                     {"since", day_text(static_cast<std::int64_t>(f.since_day))},
                     {"found", day_text(static_cast<std::int64_t>(f.found_day))}});
    return out;
  };
  ordered_json out{{"schema", "framewatch.losses/1"}, {"days", l.days},
                   {"weather", l.covariates},         {"losses", findings(l)},
                   {"damping", findings(damping)},    {"elements", ordered_json::array()}};
  out["maintenance"] = ordered_json::array();
  for (const std::int64_t day : l.maintenance_days) out["maintenance"].push_back(day_text(day));
  if (l.wrong_sensor) {
    const estimator::SensorSuspicions::Wrong& w = *l.wrong_sensor;
    out["wrong_sensor"] = {{"covariate", l.covariates[w.covariate]},
                           {"since", day_text(static_cast<std::int64_t>(w.since_day))},
                           {"reads_too_much", w.size},
                           {"std_error", w.std_error}};
  }
  for (std::size_t p = 0; p < l.state.size(); ++p)
    out["elements"].push_back({{"parameter", p == l.elements.size() ? kAll : l.elements[p].c_str()},
                               {"evidence", l.state[p].evidence},
                               {"ratio", std::expm1(l.state[p].step.size)},
                               {"std_error", l.state[p].step.std_error}});
  return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace framewatch::daemon
