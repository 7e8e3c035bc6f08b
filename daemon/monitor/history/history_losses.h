// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/monitor/events/change_words.h"
#include "daemon/monitor/history/history_days.h"
#include "daemon/monitor/history/weather_table.h"
#include "estimator/years/years_watch.h"

namespace framewatch::daemon {

/// The losses of stiffness, or growths of damping, in the daily means of a history that weather
/// does not explain.
struct HistoryLosses {
  Quantity quantity = Quantity::stiffness;
  std::vector<std::string> elements;  ///< frame stiffnesses with values
  std::vector<std::string> covariates;
  std::int64_t from_day = 0, to_day = 0;              ///< since 1970, UTC
  int days = 0;                                       ///< with values
  std::vector<std::int64_t> maintenance_days;         ///< within these
  std::vector<estimator::YearsWatch::Finding> found;  ///< in order of time
  struct State {
    double median, evidence;
    estimator::LossEvidence::Step step;
  };
  std::vector<State> state;  ///< by element, then of all of them alike
  estimator::LifeBudget budget;
  std::optional<estimator::SensorSuspicions::Wrong> wrong_sensor;  ///< of `covariates`
};

/// Watches the elements by their daily means, from the first day on. maintenance_days:
/// SummaryQuery::maintenance_days().
HistoryLosses find_losses(Quantity quantity, const std::vector<ElementDays>& elements,
                          const WeatherTable& weather, const estimator::LifeBudget& budget,
                          const std::vector<std::int64_t>& maintenance_days);

/// Returns true if the levels of `day` are not those of the day before: the building was changed on
/// purpose on that day or on the one before it, which has values of both.
bool begins_anew(const std::vector<std::int64_t>& maintenance_days, std::int64_t day);
/// Returns what these days mean for the search; "" without any.
std::string maintenance_sentence(const std::vector<std::int64_t>& days);

/// Returns which sensor of weather is probably wrong; "" if none is.
std::string wrong_sensor_sentence(const HistoryLosses& losses);

/// Returns how many losses there are, and what that means.
std::string losses_sentence(const HistoryLosses& losses);
/// Returns "5 %" or "0.01 %".
std::string probability_text(double probability);
std::string loss_sentence(const HistoryLosses& losses,
                          const estimator::YearsWatch::Finding& finding);
/// Returns the same in words for people who do not know the parameters: "story 2, frame y1
/// (kx_2_y1) lost 5.1 % of its stiffness, give or take 0.4 %, since 2026-03-04". element: a
/// parameter or kWholeBuilding.
std::string loss_words(const std::string& element, const estimator::YearsWatch::Finding& finding,
                       const FrameLabels& labels);
/// Returns a row for each element, and one for all alike: name, median in N/m, evidence, most
/// likely loss.
std::vector<std::vector<std::string>> losses_rows(const HistoryLosses& losses);
std::string losses_text(const HistoryLosses& losses);
/// Returns what the damping says beside the losses of stiffness, a sentence each; empty if no
/// damping has values. A growth at the place and time of a loss is a second sign of it.
std::vector<std::string> damping_sentences(const HistoryLosses& damping,
                                           const HistoryLosses& stiffness);
std::string losses_json(const HistoryLosses& stiffness, const HistoryLosses& damping);

}  // namespace framewatch::daemon
