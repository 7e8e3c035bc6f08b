#include "daemon/monitor/estimation/channel_events.h"

#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/monitor/events/event_words.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kFirstChannelId = std::int64_t{1} << 43;

std::string silent_message(const std::string& name, bool raised, bool ever) {
  if (!raised) return fmt::format("{} sends samples again", name);
  return ever ? fmt::format("{} is silent: no sample comes from it any more", name)
              : fmt::format("{} is silent: no sample has come from it yet", name);
}

std::string stuck_message(const std::string& name, bool raised) {
  return raised ? fmt::format(
                      "{} is stuck: its value stands still while the building moves; its "
                      "samples are left out",
                      name)
                : fmt::format("{} moves again", name);
}

}  // namespace

ChannelEvents::ChannelEvents(const std::vector<estimator::SensorAxis>& axes, double lateness_s)
    : axes_(axes),
      silent_s_(kSilent_s + static_cast<int>(std::ceil(lateness_s))),
      channels_(axes.size()) {}

void ChannelEvents::sample(const estimator::AccelSample& s) {
  if (s.axis < 0 || static_cast<std::size_t>(s.axis) >= channels_.size()) return;
  Channel& channel = channels_[static_cast<std::size_t>(s.axis)];
  channel.changed = channel.changed || s.accel != channel.value;
  channel.value = s.accel;
}

bool ChannelEvents::turns(Trouble& t, bool speaks_for, bool speaks_against, int raise_s,
                          int clear_s) {
  t.seconds = (t.raised ? speaks_against : speaks_for) ? t.seconds + 1 : 0;
  if (t.seconds < (t.raised ? clear_s : raise_s)) return false;
  t.raised = !t.raised;
  t.seconds = 0;
  return true;
}

std::vector<event_t> ChannelEvents::look(const std::vector<estimator::AxisCounters>& counters,
                                         std::int64_t time_us) {
  std::vector<event_t> out;
  for (std::size_t a = 0; a < channels_.size(); ++a) {
    Channel& c = channels_[a];
    const std::int64_t came = counters[a].received - c.received;
    const std::int64_t stuck = counters[a].stuck - c.stuck;
    c.received = counters[a].received;
    c.stuck = counters[a].stuck;
    if (came > 0 || c.heard_us == 0) c.heard_us = time_us;
    if (turns(c.silent, came <= 0, came > 0, silent_s_, 1)) {
      if (c.silent.raised) c.silent.since_us = c.heard_us;
      out.push_back(event_of(a, c.silent, true, time_us));
    }
    if (turns(c.still, came > 0 && 2 * stuck > came, came > 0 && stuck <= 0 && c.changed, kStuck_s,
              kMoving_s)) {
      if (c.still.raised) c.still.since_us = time_us - kStuck_s * kSecond_us;
      out.push_back(event_of(a, c.still, false, time_us));
    }
    c.changed = false;
  }
  return out;
}

event_t ChannelEvents::event_of(std::size_t axis, const Trouble& trouble, bool silent,
                                std::int64_t time_us) const {
  event_t m{};
  m.time_us = time_us;
  m.since_us = trouble.since_us;
  m.id = kFirstChannelId + 2 * static_cast<std::int64_t>(axis) + (silent ? 0 : 1);
  m.state = trouble.raised ? event_state::raised : event_state::cleared;
  m.severity = trouble.raised ? severity::warning : severity::information;
  m.kind = silent ? "channel_silent" : "channel_stuck";
  m.place = axes_[axis].name;
  m.value = 1e-6 * static_cast<double>(time_us - trouble.since_us);
  m.std_error = std::numeric_limits<double>::quiet_NaN();
  m.unit = "s";
  m.message = silent ? silent_message(m.place, trouble.raised, channels_[axis].received > 0)
                     : stuck_message(m.place, trouble.raised);
  return m;
}

}  // namespace framewatch::daemon
