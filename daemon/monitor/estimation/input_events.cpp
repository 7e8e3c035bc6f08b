// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/input_events.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/events/warning_event.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kFirstAbsurdId = std::int64_t{1} << 42;

using Kind = drivers::CanNotice::Kind;

constexpr std::int64_t kFirstId = std::int64_t{1} << 40;
constexpr std::array kCanKinds = {"bus_off",       "interface_gone", "emergency", "boot_up",
                                  "sequence_leap", "duplicates",     "losses"};
static_assert(kCanKinds.size() == static_cast<std::size_t>(Kind::losses) + 1);

std::string message_of(Kind kind, const std::string& place, bool over, int code) {
  switch (kind) {
    case Kind::bus_off:
      return place + (over ? ": is on the bus again"
                           : ": bus-off, nothing is received. Check the cable and its termination");
    case Kind::interface_gone:
      return place + (over ? ": is there again"
                           : ": is down or gone; framewatch waits for it. Bring the interface up");
    case Kind::emergency:
      return over ? place + ": the CANopen emergency is over"
                  : fmt::format("{}: CANopen emergency {:04X}h", place, code);
    case Kind::boot_up:
      return place + ": has booted";
    case Kind::sequence_leap:
      return place +
             (over ? ": its sequence numbers are continuous again"
                   : ": its sequence numbers jumped: it restarted, or another node has its ids");
    case Kind::duplicates:
      return over ? place + ": its messages no longer come twice"
                  : fmt::format("{}: {} messages came twice within 10 s", place, code);
    case Kind::losses:
      return over ? place + ": its messages are no longer lost"
                  : fmt::format("{}: {} messages were lost within 10 s", place, code);
  }
  return place;
}

constexpr std::int64_t kFirstChannelId = std::int64_t{1} << 43;

std::string silent_message(const std::string& name, bool raised, bool ever) {
  if (!raised) return fmt::format("{} sends samples again", name);
  return ever ? fmt::format(
                    "{} is silent: its samples have stopped. Check the sensor and its connection",
                    name)
              : fmt::format("{} is silent: no sample has come from it yet", name);
}

std::string stuck_message(const std::string& name, bool raised) {
  return raised ? fmt::format(
                      "{} is stuck: its value does not change while the building moves; its "
                      "samples are left out. Check the sensor",
                      name)
                : fmt::format("{} moves again", name);
}

using drivers::IntakeNotice;
using drivers::SequenceTrouble;

constexpr std::int64_t kFirstIntakeId = std::int64_t{1} << 41;
constexpr std::size_t kLongestName = 64;

std::size_t kind_of(const IntakeNotice& n) {
  return n.of_table ? drivers::kSequenceTroubles : static_cast<std::size_t>(n.trouble);
}

/// Returns the sender's text with printable ASCII only, shortened.
std::string plain(const std::string& name) {
  std::string out = name.substr(0, kLongestName);
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return out;
}

std::string address(const std::string& stream, std::int32_t node, int axis) {
  return fmt::format("node {} {} of {}", node, axis >= 0 && axis <= 2 ? "xyz"[axis] : '?', stream);
}

std::string table_message(const IntakeNotice& n, const Config& config) {
  const std::string& name = config.pipeline.axes[n.axis].name;
  const std::string told = address(n.stream, n.told.node, n.told.axis);
  if (n.over) return fmt::format("no channel table contradicts {} any more", name);
  const AxisSource& source = config.sources[n.axis];
  const std::string what =
      n.told.name == name
          ? fmt::format("a channel table says that {} is {}", name, told)
          : fmt::format("a channel table calls {} \"{}\"", told, plain(n.told.name));
  return source.sensor_node >= 0
             ? fmt::format("{}, the configuration says that {} is {}: the configuration holds",
                           what, name, address(source.lcm_channel, source.sensor_node, source.axis))
             : fmt::format(
                   "{}, an earlier table names another node for {}, whose samples still come: the "
                   "earlier table is used",
                   what, name);
}

std::string two_senders_message(const IntakeNotice& n, const Config& config) {
  const std::string node = fmt::format("node {} of {}", n.node, n.stream);
  if (n.over) return fmt::format("{} has one sender again", node);
  const bool none = config.lcm.two_senders == drivers::TwoSenders::none;
  if (n.other == drivers::LcmSender{})
    return fmt::format(
        "two send under {}: {}", node,
        none ? "no sample of it is used"
             : "the samples of the first are used if the senders can be distinguished, "
               "otherwise none");
  return fmt::format("{} send under {}: {}",
                     drivers::to_text(n.bound) + " and " + drivers::to_text(n.other), node,
                     none ? "no sample of it is used" : "only the samples of the first are used");
}

std::string message_of(const IntakeNotice& n, const Config& config) {
  if (n.of_table) return table_message(n, config);
  const std::string node = fmt::format("node {} of {}", n.node, n.stream);
  switch (n.trouble) {
    case SequenceTrouble::two_senders:
      return two_senders_message(n, config);
    case SequenceTrouble::leaps:
      return n.over ? fmt::format("the sequence numbers of {} are continuous again", node)
                    : fmt::format(
                          "the numbers of {} leapt from {} to {}: it began anew, or they "
                          "are not its own",
                          node, n.from, n.to);
    case SequenceTrouble::duplicates:
      return n.over
                 ? fmt::format("the messages of {} no longer come twice", node)
                 : fmt::format("{} messages of {} came twice, of {} in 10 s", n.count, node, n.of);
    case SequenceTrouble::losses:
      return n.over
                 ? fmt::format("the messages of {} are no longer lost", node)
                 : fmt::format("{} messages of {} were lost, of {} in 10 s", n.count, node, n.of);
  }
  return node;
}

constexpr const char* kIntakeKinds[] = {"two_senders", "sequence_leap", "duplicates", "losses",
                                        "channel_table"};

}  // namespace

CanEvents::CanEvents(const drivers::CanMap& map)
    : map_(map), begun_(kCanKinds.size() * std::max(map.buses.size(), map.nodes.size())) {}

std::optional<event_t> CanEvents::of(const drivers::CanNotice& n) {
  const std::size_t width = begun_.size() / kCanKinds.size();
  const auto index = static_cast<std::size_t>(n.index);
  const std::size_t at = static_cast<std::size_t>(n.kind) * width + index;
  const bool of_bus = n.kind == Kind::bus_off || n.kind == Kind::interface_gone;
  const std::string& place = of_bus ? map_.buses[index].interface : map_.nodes[index].name;
  Begun& begun = begun_[at];
  const bool momentary = n.kind == Kind::boot_up;
  if (!momentary && begun.on == !n.over && (n.over || begun.code == n.code)) return std::nullopt;
  event_t m{};
  m.time_us = n.time_us;
  m.state = momentary || n.over ? event_state::cleared
            : begun.on          ? event_state::changed
                                : event_state::raised;
  if (!begun.on) begun.since_us = n.time_us;
  begun.on = !momentary && !n.over;
  begun.code = n.code;
  m.since_us = begun.since_us;
  m.id = kFirstId + static_cast<std::int64_t>(at);
  const bool of_numbers = n.kind >= Kind::sequence_leap;
  m.severity = momentary || (of_numbers && n.over) ? severity::information
               : of_numbers || n.over              ? severity::warning
                                                   : severity::alarm;
  m.kind = kCanKinds[static_cast<std::size_t>(n.kind)];
  m.place = place;
  m.value = n.code;
  m.message = message_of(n.kind, place, n.over, n.code);
  return m;
}

ChannelEvents::ChannelEvents(const std::vector<estimator::SensorAxis>& axes, double lateness_s)
    : axes_(axes),
      silent_s_(kSilent_s + static_cast<int>(std::ceil(lateness_s))),
      absurd_(axes.size()),
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

bool ChannelEvents::turns(Absurd& absurd, std::int64_t seen, std::int64_t time_us) {
  const std::int64_t before = std::exchange(absurd.seen, seen);
  absurd.newest_us = std::min(absurd.newest_us, time_us);  // the clock may have been set back
  if (seen > before) {
    absurd.newest_us = time_us;
    if (absurd.raised) return false;
    absurd.raised = true;
    absurd.since_us = time_us;
    absurd.before = before;
    return true;
  }
  if (!absurd.raised || time_us - absurd.newest_us < kQuiet_s * kSecond_us) return false;
  absurd.raised = false;
  return true;
}

std::vector<event_t> ChannelEvents::update(const std::vector<estimator::AxisCounters>& counters,
                                           std::int64_t time_us) {
  std::vector<event_t> out;
  for (std::size_t a = 0; a < absurd_.size(); ++a)
    if (turns(absurd_[a], counters[a].absurd, time_us)) out.push_back(absurd_event(a, time_us));
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
  event_t m = warning_event(
      {silent ? "channel_silent" : "channel_stuck", axes_[axis].name,
       kFirstChannelId + 2 * static_cast<std::int64_t>(axis) + (silent ? 0 : 1), trouble.since_us},
      raised_or_cleared(trouble.raised), time_us);
  m.value = 1e-6 * static_cast<double>(time_us - trouble.since_us);
  m.unit = "s";
  m.message = silent ? silent_message(m.place, trouble.raised, channels_[axis].received > 0)
                     : stuck_message(m.place, trouble.raised);
  return m;
}

event_t ChannelEvents::absurd_event(std::size_t axis, std::int64_t time_us) const {
  const Absurd& absurd = absurd_[axis];
  const std::int64_t count = absurd.seen - absurd.before;
  event_t m = warning_event({"absurd_samples", axes_[axis].name,
                             kFirstAbsurdId + static_cast<std::int64_t>(axis), absurd.since_us},
                            raised_or_cleared(absurd.raised), time_us);
  m.value = static_cast<double>(count);
  m.unit = "samples";
  m.message = absurd.raised ? fmt::format(
                                  "{} sends values that no sensor can measure: {} so far, all "
                                  "left out. Check the sensor",
                                  m.place, count)
                            : fmt::format("{} sends plausible values again; {} were left out",
                                          m.place, count);
  return m;
}

std::optional<event_t> intake_event(const IntakeNotice& n, const Config& config,
                                    const RaisedEvents& raised, std::int64_t now_us) {
  const std::size_t kind = kind_of(n);
  event_t m{};
  m.time_us = m.since_us = now_us;
  m.id = kFirstIntakeId + static_cast<std::int64_t>(kind * config.pipeline.axes.size() + n.axis);
  const auto before = std::ranges::find(raised.all(), m.id, &event_t::id);
  if (n.over && before == raised.all().end()) return std::nullopt;
  if (n.over) m.since_us = before->since_us;
  m.state = n.over ? event_state::cleared : event_state::raised;
  const bool grave = n.of_table ? n.told.name == config.pipeline.axes[n.axis].name
                                : n.trouble == SequenceTrouble::two_senders;
  m.severity = n.over ? severity::information : grave ? severity::alarm : severity::warning;
  m.kind = kIntakeKinds[kind];
  m.place = config.pipeline.axes[n.axis].name;
  m.value = n.of_table || n.over ? 0 : static_cast<double>(n.count);
  m.unit = n.of_table ? "" : "messages";
  m.message = message_of(n, config);
  return m;
}

}  // namespace framewatch::daemon
