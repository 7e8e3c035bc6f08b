// SPDX-License-Identifier: MIT
#include "drivers/lcm/accel_intake.h"

#include <algorithm>
#include <bit>
#include <iterator>

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kCheck_us = 1'000'000;
constexpr std::int64_t kMovable_us =
    10'000'000;                          // silence after which a table may bind an axis elsewhere
constexpr std::size_t kMaxHeard = 4096;  // nodes, beyond those that are bound

/// Returns a digest of time and values, never 0.
std::uint64_t digest_of(const SensorNodeSample& sample) {
  auto digest = static_cast<std::uint64_t>(to_microseconds(sample.time));
  for (const double value : sample.accel_abs_mps2) {
    digest = (digest ^ std::bit_cast<std::uint64_t>(value)) * 0x9E3779B97F4A7C15u;
    digest ^= digest >> 29;
  }
  return digest | 1;
}

}  // namespace

bool BoundSender::takes(const LcmSender& sender, std::int64_t arrival_us) {
  if (sender == LcmSender{}) return true;
  // The receiver's clock may have been set back.
  arrival_us_ = std::min(arrival_us_, arrival_us);
  contested_until_us_ = std::min(contested_until_us_, arrival_us + kHold_us);
  const bool unbound = bound_ == LcmSender{};
  if (sender != bound_ && !unbound && arrival_us - arrival_us_ <= kSilent_us) {
    other_ = sender;
    other_was_last_ = true;
    ++others;
    return false;
  }
  if (std::exchange(other_was_last_, false) && sender == bound_) {
    ++contests;
    contested_until_us_ = arrival_us + kHold_us;
  }
  bound_ = sender;
  arrival_us_ = arrival_us;
  return true;
}

AccelIntake::AccelIntake(std::vector<WantedAxis> wanted, Sink sink, IntakeSettings settings)
    : binding_(wanted),
      sink_(std::move(sink)),
      settings_(settings),
      node_of_axis_(wanted.size(), nullptr),
      contradicted_(wanted.size()) {}

IntakeResult AccelIntake::message(const std::string& channel, const void* data, std::size_t size,
                                  const LcmSender& sender, std::int64_t received_us) {
  ++counters_.messages;
  IntakeResult result = IntakeResult::foreign;
  if (carried(channel))
    result = accel(channel, data, size, sender, received_us);
  else if (const std::string stream = stream_of_table(channel); !stream.empty())
    result = table(stream, data, size, received_us);
  counters_.foreign += result == IntakeResult::foreign;
  counters_.malformed += result == IntakeResult::malformed;
  counters_.duplicate += result == IntakeResult::duplicate;
  counters_.other_sender += result == IntakeResult::other_sender;
  return result;
}

void AccelIntake::log_begins() {
  for (auto& [place, node] : heard_) node.in_input = 0;
}

bool AccelIntake::is_silent(const std::string& stream, std::int32_t node,
                            std::int64_t arrival_us) const {
  const auto at = heard_.find({stream, node});
  return at == heard_.end() || at->second.in_input == 0 ||
         arrival_us - at->second.counter.newest_arrival_us() > kMovable_us;
}

IntakeResult AccelIntake::table(const std::string& stream, const void* data, std::size_t size,
                                std::int64_t received_us) {
  const std::optional<ChannelTable> table = decode_channel_table(data, size);
  if (!table) return binding_.carries(stream) ? IntakeResult::malformed : IntakeResult::foreign;
  const std::int64_t arrival_us = received_us != 0 ? received_us : arrival_us_;
  const auto against = binding_.apply(
      stream, *table,
      [&](const std::string& of, std::int32_t node) { return is_silent(of, node, arrival_us); });
  for (const AxisBinding::Contradiction& c : against) {
    ++(c.elsewhere ? counters_.elsewhere : counters_.renamed);
    check_table(c.wanted, arrival_us, &c, stream);
  }
  stream_.clear();
  forget_unbound();
  return binding_.carries(stream) ? IntakeResult::table : IntakeResult::foreign;
}

void AccelIntake::forget_unbound() {
  if (heard_.size() <= kMaxHeard + node_of_axis_.size()) return;
  std::erase_if(heard_, [this](const auto& heard) {
    const bool bound = binding_.axes_of(heard.first.first, heard.first.second) != nullptr;
    for (const HeardNode*& node : node_of_axis_)
      if (!bound && node == &heard.second) node = nullptr;
    return !bound;
  });
}

bool AccelIntake::carried(const std::string& channel) {
  if (channel == stream_ && !stream_.empty()) return true;
  if (!binding_.carries(channel)) return false;
  stream_ = channel;
  nodes_.clear();
  next_node_ = 0;
  return true;
}

std::int64_t AccelIntake::number_of(const HeardNode* node) const {
  std::int64_t number = 0;
  for (const auto& [place, heard] : heard_) {
    if (&heard == node) return number;
    ++number;
  }
  return -1;
}

const HeardNode* AccelIntake::node_numbered(std::int64_t number) const {
  if (number < 0 || number >= std::ssize(heard_)) return nullptr;
  return &std::next(heard_.begin(), number)->second;
}

/// Returns null when the node carries no configured axis. Fast when nodes come in the same order
/// each time.
const AccelIntake::Node* AccelIntake::find_node(const std::string& channel, std::int32_t number) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const std::size_t at =
        next_node_ + i < nodes_.size() ? next_node_ + i : next_node_ + i - nodes_.size();
    if (nodes_[at].number != number) continue;
    next_node_ = at + 1 < nodes_.size() ? at + 1 : 0;
    return &nodes_[at];
  }
  const AxisBinding::NodeAxes* axes = binding_.axes_of(channel, number);
  if (axes == nullptr) return nullptr;
  const auto [at, is_new] = heard_.try_emplace({channel, number}, settings_.rate_hz);
  HeardNode& heard = at->second;
  if (is_new) {
    heard.order = nodes_heard_++;
    heard.axis = static_cast<std::size_t>(*std::find_if(
        axes->begin(), axes->end(), [](int axis) { return axis != AxisBinding::kNone; }));
  }
  nodes_.push_back({number, *axes, &heard});
  next_node_ = 0;
  return &nodes_.back();
}

IntakeResult AccelIntake::accel(const std::string& channel, const void* data, std::size_t size,
                                const LcmSender& sender, std::int64_t received_us) {
  const std::optional<SensorNodeSample> sample = decode_accel(data, size);
  if (!sample) return IntakeResult::malformed;
  const Node* node = find_node(channel, sample->node);
  if (node == nullptr) return IntakeResult::foreign;
  arrival_us_ = received_us != 0 ? received_us : to_microseconds(sample->time);
  if (arrival_us_ >= next_check_us_ || next_check_us_ - arrival_us_ > kCheck_us)
    check_nodes(arrival_us_);
  for (const int axis : node->axes)
    if (axis != AxisBinding::kNone) node_of_axis_[static_cast<std::size_t>(axis)] = node->heard;
  HeardNode& heard = *node->heard;
  const IntakeResult result = judge(heard, *sample, sender);
  if (heard.counter.gives_held()) give(*node, heard.held);
  if (result == IntakeResult::held) heard.held = *sample;
  if (result == IntakeResult::samples) give(*node, *sample);
  return result;
}

void AccelIntake::give(const Node& node, const SensorNodeSample& sample) {
  last_sample_ = sample;
  last_node_ = node.heard->order;
  for (std::size_t i = 0; i < node.axes.size(); ++i)
    if (node.axes[i] != AxisBinding::kNone)
      sink_({sample.time, node.axes[i], sample.accel_abs_mps2[i]});
}

/// Decides whether the message is new and from the sender that is followed.
IntakeResult AccelIntake::judge(HeardNode& node, const SensorNodeSample& sample,
                                const LcmSender& sender) {
  node.in_input = 1;
  if (!node.sender.takes(sender, arrival_us_)) return IntakeResult::other_sender;
  SequenceCounter& counter = node.counter;
  const std::int64_t lost = counter.lost, backwards = counter.backwards;
  const auto verdict =
      counter.see({sample.sequence, to_microseconds(sample.time), arrival_us_, digest_of(sample)});
  if (std::exchange(node.away, false))
    node.unheard += std::max<std::int64_t>(counter.lost - lost, 0);
  lost_ += counter.lost - lost;
  backwards_ += counter.backwards - backwards;
  if (verdict == SequenceCounter::Verdict::duplicate) return IntakeResult::duplicate;
  if (verdict == SequenceCounter::Verdict::other) return IntakeResult::other_sender;
  if (verdict == SequenceCounter::Verdict::held) return IntakeResult::held;
  if (settings_.two_senders == TwoSenders::none && node.contested(arrival_us_)) {
    ++node.withheld;
    return IntakeResult::other_sender;
  }
  return IntakeResult::samples;
}

void AccelIntake::came_up() {
  for (auto& [place, node] : heard_) node.away = true;
}

void AccelIntake::check_nodes(std::int64_t arrival_us) {
  next_check_us_ = arrival_us + kCheck_us;
  for (auto& [place, node] : heard_) check_node(place.first, place.second, node);
  for (std::size_t axis = 0; axis < contradicted_.size(); ++axis)
    check_table(axis, arrival_us, nullptr, {});
}

/// `against` is the contradiction by a table; null when there was no contradiction.
void AccelIntake::check_table(std::size_t axis, std::int64_t arrival_us,
                              const AxisBinding::Contradiction* against,
                              const std::string& stream) {
  const auto found = contradicted_[axis].update(against != nullptr, arrival_us);
  if (!found) return;
  IntakeNotice news;
  news.of_table = true;
  news.axis = axis;
  news.over = *found == Trouble::News::over;
  news.arrival_us = arrival_us;
  news.stream = stream;
  if (against != nullptr) news.told = against->told;
  notice(news);
}

void AccelIntake::check_node(const std::string& stream, std::int32_t number, HeardNode& node) {
  for (const auto& found : node.watch.update(node.counts(), arrival_us_)) {
    if (!found) continue;
    IntakeNotice news;
    news.trouble = found->trouble;
    news.axis = node.axis;
    news.over = found->over;
    news.arrival_us = arrival_us_;
    news.stream = stream;
    news.node = number;
    news.count = found->count;
    news.of = found->of;
    news.bound = node.sender.bound();
    news.other = node.sender.other();
    news.from = node.counter.leapt_from();
    news.to = node.counter.leapt_to();
    notice(news);
  }
}

void AccelIntake::notice(const IntakeNotice& notice) const {
  if (notice_) notice_(notice);
}

}  // namespace framewatch::drivers
