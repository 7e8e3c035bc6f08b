// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/estimation_events.h"

#include <cmath>
#include <string>

#include <fmt/core.h>

#include "daemon/base/utc_time.h"
#include "daemon/config/learned_files.h"
#include "daemon/monitor/events/change_words.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/events/warning_event.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {

namespace {

using estimator::ChangeReason;

std::string end_words(const estimator::Alarm& alarm, const std::string& name) {
  switch (alarm.reason) {
    case ChangeReason::not_confirmed:
      return fmt::format("{} has not changed: the windows behind the alarm do not show it", name);
    case ChangeReason::of_all:
      return fmt::format("{} has not changed alone: every stiffness has changed alike", name);
    default:
      return fmt::format("{} is at its baseline again", name);
  }
}

std::string change_words(const estimator::Alarm& alarm, const estimator::ParameterTable& table,
                         const FrameLabels& labels) {
  const estimator::Change& c = alarm.change;
  if (alarm.parameter == estimator::ChangeRecord::kEverything)
    return common_change_sentence(c.ratio, alarm.measured ? c.std_error : estimator::kNaN);
  const estimator::Parameter& p = table[alarm.parameter];
  if (!alarm.measured) return changing_sentence(p, c.ratio, labels);
  return change_sentence(p, c.ratio, c.std_error, labels) +
         (alarm.reason == ChangeReason::further ? "; it has changed further" : "");
}

/// Larger than the ids of all other events.
constexpr std::int64_t kFirstDoubtId = std::int64_t{1} << 46;

std::string percent(double ratio) {
  return fmt::format("{:.{}f} %", 100 * ratio, ratio < 1 ? 1 : 0);
}

std::string fault_words(const estimator::ChannelLaw& law,
                        const std::vector<estimator::SensorAxis>& axes) {
  using estimator::ChannelFault;
  const auto at = static_cast<std::size_t>(law.other);  // may come from a state file
  const std::string other = at < axes.size() ? axes[at].name : "another channel";
  switch (law.fault) {
    case ChannelFault::gain:
      return fmt::format("reads {} too {}", percent(std::abs(law.value - 1)),
                         law.value > 1 ? "much" : "little");
    case ChannelFault::polarity:
      return "reads the motion with the other sign";
    case ChannelFault::late:
      return fmt::format("reads {:.2g} ms too {}", 1e3 * std::abs(law.value),
                         law.value > 0 ? "late" : "early");
    case ChannelFault::clock:
      return fmt::format("has a clock that is {:.2g} ppm too {}", 1e6 * std::abs(law.value),
                         law.value > 0 ? "fast" : "slow");
    case ChannelFault::exchanged:
      return fmt::format("is exchanged with {}", other);
    case ChannelFault::repeats:
      return fmt::format("repeats {}", other);
    case ChannelFault::only_noise:
      return "does not move with the building";
    case ChannelFault::saturated:
      return fmt::format("saturates at {:.2g} m/s^2", law.value);
    case ChannelFault::bandwidth:
      return fmt::format("follows the motion only below {:.2g} Hz", law.value);
    case ChannelFault::unlike:
      break;
  }
  return "reads something else than the building's motion";
}

}  // namespace

event_t stiffness_event(const estimator::Alarm& alarm, const estimator::ParameterTable& table,
                        const FrameLabels& labels) {
  const bool everything = alarm.parameter == estimator::ChangeRecord::kEverything;
  const bool over = alarm.state == estimator::AlarmState::cleared;
  event_t m{};
  m.time_us = to_microseconds(alarm.found);
  m.since_us = to_microseconds(alarm.change.since);
  m.id = alarm.id;
  m.state = static_cast<std::int32_t>(alarm.state);
  m.severity = over || everything ? severity::warning : severity::alarm;
  m.kind = "stiffness_change";
  m.place = everything ? kWholeBuilding : table[alarm.parameter].name;
  m.value = alarm.measured ? 100 * alarm.change.ratio : estimator::kNaN;
  m.std_error = alarm.measured ? 100 * alarm.change.std_error : estimator::kNaN;
  m.unit = "%";
  m.message = over ? end_words(alarm, everything ? "everything" : named_place(m.place, labels))
                   : fmt::format("{}, since {}", change_words(alarm, table, labels),
                                 sensor_time_text(m.since_us));
  return m;
}

event_t recovering(event_t event, const estimator::RecoveryLaw& law) {
  const bool early = law.verdict == estimator::RecoveryVerdict::not_known &&
                     law.time_s < estimator::Recovery::kRenew_s[0];
  if (event.state == event_state::cleared || early) return event;
  event.message += kAfterStrongMotion + recovery_words(law);
  return event;
}

event_t renewed(event_t raised, estimator::Time now) {
  raised.time_us = to_microseconds(now);
  raised.state = event_state::changed;
  raised.message = raised.message.substr(0, raised.message.find(kAfterStrongMotion));
  return raised;
}

event_t gap_event(const estimator::GapNews& news, const Config& config) {
  const bool raised = news.state != estimator::AlarmState::cleared;
  const auto worst = static_cast<std::size_t>(news.worst_axis);  // may come from a state file
  const std::string channel =
      worst < config.pipeline.axes.size() ? config.pipeline.axes[worst].name : "";
  const estimator::ParameterTable table = config.pipeline.parameters();
  const bool named = news.parameter >= 0 && news.parameter < table.elements();
  event_t m = warning_event(
      {"gap", named ? table[news.parameter].name : channel, news.id, to_microseconds(news.since)},
      static_cast<std::int32_t>(news.state), to_microseconds(news.found));
  m.value = 100 * news.excess;
  m.unit = "%";
  m.segment = segment_name(config, news.id);
  m.message =
      raised
          ? fmt::format("simulation and measurement differ by {:.0f} % beyond noise, most at {}",
                        m.value, channel)
          : fmt::format("simulation and measurement agree again: {:.0f} % beyond noise", m.value);
  if (named && raised)
    m.message += fmt::format("; {} is {:.1f} % (+-{:.1f} %) {} the model",
                             named_place(m.place, frame_labels(config.pipeline.structure)),
                             100 * std::abs(news.ratio), 100 * news.std_error,
                             news.ratio < 0 ? "below" : "above");
  return m;
}

event_t doubt_event(const estimator::ChannelNews& news,
                    const std::vector<estimator::SensorAxis>& axes) {
  const bool over = news.state == estimator::AlarmState::cleared;
  event_t m = warning_event({"channel_doubted", axes[static_cast<std::size_t>(news.axis)].name,
                             kFirstDoubtId + news.axis, to_microseconds(news.since)},
                            static_cast<std::int32_t>(news.state), to_microseconds(news.found));
  m.value = 100 * news.departure;
  m.unit = "%";
  m.message = m.place + (over ? " reads the building's motion again"
                              : fmt::format(" {}. It differs by {} from the building's motion, "
                                            "other channels by at most {}. The estimates do "
                                            "without it",
                                            fault_words(news.law, axes), percent(news.departure),
                                            percent(news.others)));
  return m;
}

event_t withdrawn(event_t raised) {
  raised.state = event_state::cleared;
  raised.severity = severity::information;
  raised.message = "withdrawn: the new configuration does not monitor this";
  return raised;
}

}  // namespace framewatch::daemon
