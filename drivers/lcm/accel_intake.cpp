#include "drivers/lcm/accel_intake.h"

#include <iterator>
#include <utility>

namespace framewatch::drivers {

AccelIntake::AccelIntake(std::vector<WantedAxis> wanted, Sink sink)
    : binding_(wanted), sink_(std::move(sink)), sequence_of_axis_(wanted.size(), nullptr) {}

IntakeResult AccelIntake::message(const std::string& channel, const void* data, std::size_t size) {
  ++counters_.messages;
  IntakeResult result = IntakeResult::foreign;
  if (carried(channel))
    result = accel(channel, data, size);
  else if (const std::string stream = stream_of_table(channel); !stream.empty())
    result = table(stream, data, size);
  counters_.foreign += result == IntakeResult::foreign;
  counters_.malformed += result == IntakeResult::malformed;
  counters_.duplicate += result == IntakeResult::duplicate;
  return result;
}

IntakeResult AccelIntake::table(const std::string& stream, const void* data, std::size_t size) {
  const std::optional<ChannelTable> table = decode_channel_table(data, size);
  if (!table) return binding_.carries(stream) ? IntakeResult::malformed : IntakeResult::foreign;
  binding_.apply(stream, *table);
  stream_.clear();
  return binding_.carries(stream) ? IntakeResult::table : IntakeResult::foreign;
}

bool AccelIntake::carried(const std::string& channel) {
  if (channel == stream_ && !stream_.empty()) return true;
  if (!binding_.carries(channel)) return false;
  stream_ = channel;
  nodes_.clear();
  next_node_ = 0;
  return true;
}

std::int64_t AccelIntake::number_of(const SequenceCounter* counter) const {
  std::int64_t number = 0;
  for (const auto& [place, sequence] : sequences_) {
    if (&sequence.counter == counter) return number;
    ++number;
  }
  return -1;
}

const SequenceCounter* AccelIntake::counter_of(std::int64_t number) const {
  if (number < 0 || number >= std::ssize(sequences_)) return nullptr;
  return &std::next(sequences_.begin(), number)->second.counter;
}

/// Null when no configured axis is on the node. Nodes come in the same order every time, mostly.
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
  const auto [at, is_new] = sequences_.try_emplace({channel, number});
  if (is_new) at->second.order = sequences_.size() - 1;
  nodes_.push_back({number, *axes, &at->second.counter, at->second.order});
  next_node_ = 0;
  return &nodes_.back();
}

IntakeResult AccelIntake::accel(const std::string& channel, const void* data, std::size_t size) {
  const std::optional<SensorNodeSample> sample = decode_accel(data, size);
  if (!sample) return IntakeResult::malformed;
  const Node* node = find_node(channel, sample->node);
  if (node == nullptr) return IntakeResult::foreign;
  SequenceCounter& sequence = *node->sequence;
  const std::int64_t lost = sequence.lost, backwards = sequence.backwards;
  const bool is_new = sequence.see(sample->sequence, to_microseconds(sample->time)) !=
                      SequenceCounter::Verdict::duplicate;
  lost_ += sequence.lost - lost;
  backwards_ += sequence.backwards - backwards;
  last_sample_ = *sample;
  last_node_ = node->order;
  for (std::size_t i = 0; i < node->axes.size(); ++i) {
    const int axis = node->axes[i];
    if (axis == AxisBinding::kNone) continue;
    sequence_of_axis_[static_cast<std::size_t>(axis)] = &sequence;
    if (is_new) sink_({sample->time, axis, sample->accel_abs_mps2[i]});
  }
  return is_new ? IntakeResult::samples : IntakeResult::duplicate;
}

}  // namespace framewatch::drivers
