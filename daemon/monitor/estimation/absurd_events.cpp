#include "daemon/monitor/estimation/absurd_events.h"

#include <algorithm>
#include <limits>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/monitor/events/event_words.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kFirstAbsurdId = std::int64_t{1} << 42;

}  // namespace

AbsurdEvents::AbsurdEvents(const std::vector<estimator::SensorAxis>& axes)
    : axes_(axes), channels_(axes.size()) {}

std::vector<event_t> AbsurdEvents::look(const std::vector<estimator::AxisCounters>& counters,
                                        std::int64_t time_us) {
  std::vector<event_t> out;
  for (std::size_t a = 0; a < channels_.size(); ++a) {
    Channel& channel = channels_[a];
    const std::int64_t before = channel.seen;
    channel.seen = counters[a].absurd;
    channel.newest_us = std::min(channel.newest_us, time_us);  // a clock that was set back
    if (channel.seen > before) {
      channel.newest_us = time_us;
      if (channel.raised) continue;
      channel.raised = true;
      channel.since_us = time_us;
      channel.before = before;
    } else if (channel.raised && time_us - channel.newest_us >= kQuiet_s * kSecond_us) {
      channel.raised = false;
    } else {
      continue;
    }
    out.push_back(event_of(a, time_us));
  }
  return out;
}

event_t AbsurdEvents::event_of(std::size_t axis, std::int64_t time_us) const {
  const Channel& channel = channels_[axis];
  const std::int64_t count = channel.seen - channel.before;
  event_t m{};
  m.time_us = time_us;
  m.since_us = channel.since_us;
  m.id = kFirstAbsurdId + static_cast<std::int64_t>(axis);
  m.state = channel.raised ? event_state::raised : event_state::cleared;
  m.severity = channel.raised ? severity::warning : severity::information;
  m.kind = "absurd_samples";
  m.place = axes_[axis].name;
  m.value = static_cast<double>(count);
  m.std_error = std::numeric_limits<double>::quiet_NaN();
  m.unit = "samples";
  m.message =
      channel.raised
          ? fmt::format(
                "{} sends values that it cannot have measured, {} so far; they are left out",
                m.place, count)
          : fmt::format("{} sends plausible values again; {} were left out", m.place, count);
  return m;
}

}  // namespace framewatch::daemon
