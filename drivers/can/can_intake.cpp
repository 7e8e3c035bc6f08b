// SPDX-License-Identifier: MIT
#include "drivers/can/can_intake.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace framewatch::drivers {
namespace {

/// The other frames of a sample must follow the one that opens it within this share of the period.
constexpr double kAttachWindow = 0.5;
constexpr std::int64_t kCheck_us = 1'000'000;
constexpr std::int64_t kMaxStamp_us = 4'000'000'000'000'000'000;  // sums do not overflow

double modulus_of(const CanNodeMap& node) {
  const CanMessageMap& opens = node.messages.front();
  const std::optional<CanField>& field =
      node.timing == CanTiming::clock ? opens.clock : opens.counter;
  if (!field || field->value != CanValue::integer || field->bits > 52) return 0;
  const double scale = node.timing == CanTiming::clock ? std::abs(field->factor) : 1;
  return std::ldexp(scale, field->bits);
}

StreamTimer::Settings settings_of(const CanNodeMap& node) {
  StreamTimer::Settings s;
  s.kind = node.timing;
  s.period_us = node.period_us * node.samples_per_frame;
  s.tick_us = node.timing == CanTiming::clock ? node.clock_unit_us : s.period_us;
  s.modulus = modulus_of(node);
  return s;
}

}  // namespace

FrameLookup::FrameLookup(const CanMap& map, int bus) {
  for (std::size_t n = 0; n < map.nodes.size(); ++n) {
    if (map.nodes[n].bus != bus) continue;
    for (std::size_t m = 0; m < map.nodes[n].messages.size(); ++m) {
      const CanMessageMap& message = map.nodes[n].messages[m];
      auto at = std::find_if(groups_.begin(), groups_.end(), [&](const Group& g) {
        return g.mask == message.mask && g.extended == message.extended;
      });
      if (at == groups_.end()) at = groups_.insert(at, Group{message.mask, message.extended, {}});
      at->targets[message.id & message.mask].push_back({static_cast<int>(n), static_cast<int>(m)});
    }
  }
}

const std::vector<FrameLookup::Target>& FrameLookup::find(std::uint32_t id, bool extended) const {
  static const std::vector<Target> kNone;
  for (const Group& group : groups_) {
    if (group.extended != extended) continue;
    const auto at = group.targets.find(id & group.mask);
    if (at != group.targets.end()) return at->second;
  }
  return kNone;
}

CanIntake::CanIntake(const CanMap& map, Sink sink, Observer observer)
    : map_(map), sink_(std::move(sink)), observer_(std::move(observer)) {
  int axes = 0;
  for (const CanNodeMap& node : map.nodes)
    for (const CanMessageMap& message : node.messages)
      for (const CanReading& reading : message.readings) axes = std::max(axes, reading.axis + 1);
  ranges_.resize(static_cast<std::size_t>(axes));
  carrier_.assign(static_cast<std::size_t>(axes), {-1, -1});
  absurd_.assign(static_cast<std::size_t>(axes), 0);
  if (map.resample)
    resamplers_.assign(static_cast<std::size_t>(axes), Resampler(map.grid_period_us));
  bus_counters_.resize(map.buses.size());
  for (std::size_t b = 0; b < map.buses.size(); ++b)
    buses_.push_back({FrameLookup(map, static_cast<int>(b)), nullptr});
  for (const CanNodeMap& node : map.nodes) make_node(node);
}

void CanIntake::make_node(const CanNodeMap& node) {
  const int index = static_cast<int>(nodes_.size());
  Node made;
  made.sequence.resize(node.messages.size());
  made.attached.resize(node.messages.size());
  for (std::size_t m = 0; m < node.messages.size(); ++m)
    for (const CanReading& reading : node.messages[m].readings)
      carrier_[static_cast<std::size_t>(reading.axis)] = {index, static_cast<int>(m)};
  Bus& bus = buses_[static_cast<std::size_t>(node.bus)];
  if (node.timing != CanTiming::sync) {
    made.timer = std::make_unique<StreamTimer>(settings_of(node), steps_);
    made.timer->on_delivery([this, t = made.timer.get()](const TimedValues& v, double time_us) {
      deliver(v, time_us, t->period_us());
    });
  } else if (!bus.latch) {
    bus.latch = std::make_unique<SyncMatcher>(map_, node.bus, steps_,
                                              [this, &bus](const TimedValues& v, double time_us) {
                                                deliver(v, time_us, bus.latch->period_us());
                                              });
  }
  nodes_.push_back(std::move(made));
}

int CanIntake::bus_of(std::string_view interface) const {
  for (std::size_t b = 0; b < map_.buses.size(); ++b)
    if (map_.buses[b].interface == interface) return static_cast<int>(b);
  return -1;
}

void CanIntake::frame(int index, const CanFrame& frame) {
  CanBusCounters& counters = bus_counters_[static_cast<std::size_t>(index)];
  Bus& bus = buses_[static_cast<std::size_t>(index)];
  newest_stamp_us_ = std::max(newest_stamp_us_, frame.stamp_us);
  if (frame.stamp_us >= next_check_us_ || frame.stamp_us < next_check_us_ - kCheck_us)
    check_nodes(frame.stamp_us);
  const bool was_off = counters.state == CanBusState::off;
  if (frame.error)
    count_error_frame(frame, counters);
  else if (was_off)
    counters.state = CanBusState::active;
  const bool is_off = counters.state == CanBusState::off;
  if (is_off != was_off) notice({CanNotice::Kind::bus_off, index, was_off, 0, frame.stamp_us});
  if (frame.error) return;
  ++counters.frames;
  if (frame.remote) {
    ++counters.remote;
    return;
  }
  const double host_us = steps_.continuous(static_cast<double>(frame.stamp_us));
  const CanBusMap& settings = map_.buses[static_cast<std::size_t>(index)];
  if (bus.latch && frame.id == settings.sync_id && frame.extended == (settings.sync_id > 0x7FF)) {
    ++counters.syncs;
    return bus.latch->sync(frame, host_us);
  }
  const bool has_value = !map_.values.empty() && values(index, frame);
  const std::vector<FrameLookup::Target>& targets = bus.lookup.find(frame.id, frame.extended);
  if (targets.empty()) {
    counters.foreign += !canopen(index, frame) && !has_value;
    return;
  }
  for (const FrameLookup::Target& target : targets)
    message(target.node, target.message, frame, host_us);
}

/// Passes on the values of a frame. Returns false if CanMap::values lacks its message.
bool CanIntake::values(int bus, const CanFrame& frame) const {
  bool ours = false;
  for (const CanValueMap& map : map_.values) {
    const CanMessageMap& m = map.message;
    if (map.bus != bus || frame.extended != m.extended || (frame.id & m.mask) != (m.id & m.mask))
      continue;
    ours = true;
    const bool whole = frame.fd == m.fd && frame.length == m.length;
    const bool on = std::ranges::all_of(m.switches, [&](const CanSwitch& s) {
      return fits(s.field, frame.length) && is_on(s, frame.data);
    });
    if (whole && on && value_sink_)
      value_sink_(map.covariate, physical(map.field, frame.data), frame.stamp_us);
  }
  return ours;
}

/// Handles boot-up, heartbeat and EMCY. Returns false for a frame of no configured node.
bool CanIntake::canopen(int bus, const CanFrame& frame) {
  if (frame.extended || frame.fd || (frame.id & 0x7Fu) == 0) return false;
  const int id = static_cast<int>(frame.id & 0x7Fu);
  const bool heartbeat = (frame.id & 0x780u) == 0x700u && frame.length == 1;
  const bool emergency = (frame.id & 0x780u) == 0x080u && frame.length == 8;
  if (!heartbeat && !emergency) return false;
  bool ours = false;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (map_.nodes[n].canopen_id != id || map_.nodes[n].bus != bus) continue;
    ours = true;
    CanNodeCounters& c = nodes_[n].counters;
    if (heartbeat && frame.data[0] == 0) {
      ++c.boot_ups;
      notice({CanNotice::Kind::boot_up, static_cast<int>(n), false, 0, frame.stamp_us});
      if (nodes_[n].timer) nodes_[n].timer->restart();
    }
    if (!emergency) continue;
    c.last_emergency = static_cast<std::uint16_t>(frame.data[0] | frame.data[1] << 8);
    c.emergencies += c.last_emergency != 0;
    notice({CanNotice::Kind::emergency, static_cast<int>(n), c.last_emergency == 0,
            c.last_emergency, frame.stamp_us});
  }
  return ours;
}

void CanIntake::notice(const CanNotice& notice) const {
  if (notice_) notice_(notice);
}

/// Sends notices when the numbers of a node begin or cease to be in trouble.
void CanIntake::check_nodes(std::int64_t stamp_us) {
  using Kind = CanNotice::Kind;
  next_check_us_ = std::clamp(stamp_us, -kMaxStamp_us, kMaxStamp_us) + kCheck_us;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const CanNodeCounters c = node(n);
    const bool counts = map_.nodes[n].timing != CanTiming::period;
    const SequenceWatch::Counts seen{c.received, c.lost, c.duplicates, counts ? c.restarts : 0, 0};
    for (const auto& news : nodes_[n].watch.update(seen, stamp_us)) {
      if (!news) continue;
      const Kind kind = news->trouble == SequenceTrouble::leaps        ? Kind::sequence_leap
                        : news->trouble == SequenceTrouble::duplicates ? Kind::duplicates
                                                                       : Kind::losses;
      notice({kind, static_cast<int>(n), news->over,
              static_cast<int>(std::min<std::int64_t>(news->count, 1'000'000'000)), stamp_us});
    }
  }
}

void CanIntake::message(int index, int at, const CanFrame& frame, double host_us) {
  Node& node = nodes_[static_cast<std::size_t>(index)];
  const CanMessageMap& m =
      map_.nodes[static_cast<std::size_t>(index)].messages[static_cast<std::size_t>(at)];
  for (const CanSwitch& multiplexor : m.switches)
    if (fits(multiplexor.field, frame.length) && !is_on(multiplexor, frame.data)) return;
  ++node.counters.frames;
  node.counters.last_stamp_us = frame.stamp_us;
  if (frame.fd != m.fd) {
    ++node.counters.wrong_kind;
    return;
  }
  if (frame.length != m.length) {
    ++node.counters.wrong_length;
    return;
  }
  TimedValues values{index, at, 0, {}};
  values.values.reserve(m.readings.size());
  for (const CanReading& reading : m.readings) {
    const double value = physical(reading.field, frame.data);
    values.values.push_back(value);
    node.counters.not_finite += !std::isfinite(value);
  }
  place(node, at, frame, std::move(values), host_us);
}

void CanIntake::place(Node& node, int at, const CanFrame& frame, TimedValues values,
                      double host_us) {
  const auto m = static_cast<std::size_t>(at);
  const CanNodeMap& map = map_.nodes[static_cast<std::size_t>(values.node)];
  if (map.timing == CanTiming::sync)
    return buses_[static_cast<std::size_t>(map.bus)].latch->add(frame, host_us, std::move(values));
  if (at > 0) {
    const double after_us = host_us - node.opened_us;
    const double window_us = kAttachWindow * map.period_us * map.samples_per_frame;
    if (after_us < 0 || after_us > window_us || node.attached[m] != 0) {
      ++node.counters.unplaced;
      return;
    }
    node.attached[m] = 1;
    return node.timer->attach(std::move(values));
  }
  node.opened_us = host_us;
  std::fill(node.attached.begin(), node.attached.end(), std::uint8_t{0});
  double reading = 0;
  if (map.timing == CanTiming::clock) reading = physical(*map.messages[m].clock, frame.data);
  if (map.timing == CanTiming::counter)
    reading = static_cast<double>(raw_integer(*map.messages[m].counter, frame.data));
  if (!std::isfinite(reading) || std::abs(reading) > 1e15) {
    ++node.counters.unplaced;
    return;
  }
  node.timer->open_sample(reading, host_us, std::move(values));
}

/// Returns false for values, read from a state file, that do not fit the map.
bool CanIntake::known(const TimedValues& v) const {
  if (v.node < 0 || static_cast<std::size_t>(v.node) >= map_.nodes.size()) return false;
  const std::vector<CanMessageMap>& messages =
      map_.nodes[static_cast<std::size_t>(v.node)].messages;
  return v.message >= 0 && static_cast<std::size_t>(v.message) < messages.size() &&
         messages[static_cast<std::size_t>(v.message)].readings.size() == v.values.size();
}

void CanIntake::deliver(const TimedValues& v, double time_us, double frame_us) {
  if (!known(v)) return;
  Node& node = nodes_[static_cast<std::size_t>(v.node)];
  const CanNodeMap& map = map_.nodes[static_cast<std::size_t>(v.node)];
  SequenceCounter& sequence = node.sequence[static_cast<std::size_t>(v.message)];
  const double offset_us = map.timing == CanTiming::sync
                               ? map.delay_us
                               : -map.latency_us - map.period_us * (map.samples_per_frame - 1);
  const double first_us = time_us + offset_us;
  if (sequence.see(v.number, std::llround(first_us)) == SequenceCounter::Verdict::duplicate) return;
  if (v.message == 0) {
    CanNodeCounters& c = node.counters;
    if (c.received++ == 0) c.first_time_us = first_us;
    c.last_time_us = std::max(c.last_time_us, first_us);
  }
  const double period_us = frame_us / map.samples_per_frame;
  const auto& readings = map.messages[static_cast<std::size_t>(v.message)].readings;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto axis = static_cast<std::size_t>(readings[i].axis);
    const double value = v.values[i];
    const double at_us = first_us + period_us * readings[i].sample;
    const std::int64_t number = v.number * map.samples_per_frame + readings[i].sample;
    if (std::isfinite(value)) {
      CanRange& range = ranges_[axis];
      range.least = range.count == 0 ? value : std::min(range.least, value);
      range.most = range.count == 0 ? value : std::max(range.most, value);
      ++range.count;
    }
    if (observer_) observer_({v.node, readings[i].axis, number, at_us, value});
    if (resamplers_.empty()) {
      sink_({estimator::from_microseconds(std::llround(at_us)), readings[i].axis, value});
      continue;
    }
    const bool absurd = value < readings[i].least || value > readings[i].most;
    absurd_[axis] += absurd;
    resamplers_[axis].add(
        number, at_us, period_us, absurd ? std::numeric_limits<double>::quiet_NaN() : value,
        [&](std::int64_t grid_us, double resampled) {
          sink_({estimator::from_microseconds(grid_us), readings[i].axis, resampled});
        });
  }
}

void CanIntake::finish() {
  for (Bus& bus : buses_)
    if (bus.latch) bus.latch->finish();
  for (Node& node : nodes_)
    if (node.timer) node.timer->finish();
}

CanNodeCounters CanIntake::node(std::size_t index) const {
  const Node& node = nodes_[index];
  CanNodeCounters out = node.counters;
  for (const SequenceCounter& s : node.sequence) {
    out.lost += s.lost;
    out.duplicates += s.duplicates;
    out.reordered += s.reordered;
  }
  const auto& latch = buses_[static_cast<std::size_t>(map_.nodes[index].bus)].latch;
  if (latch) latch->count(static_cast<int>(index), out);
  if (node.timer) {
    out.restarts += node.timer->restarts();
    out.unplaced += node.timer->unplaced();
  }
  if (!resamplers_.empty())
    for (const CanMessageMap& m : map_.nodes[index].messages)
      for (const CanReading& r : m.readings)
        out.repaired += resamplers_[static_cast<std::size_t>(r.axis)].repaired();
  return out;
}

std::int64_t CanIntake::lost_of(std::size_t axis) const {
  if (axis >= carrier_.size() || carrier_[axis].first < 0) return 0;
  const auto [node, message] = carrier_[axis];
  return nodes_[static_cast<std::size_t>(node)].sequence[static_cast<std::size_t>(message)].lost;
}

}  // namespace framewatch::drivers
