#include "drivers/accel_intake.h"

#include <numeric>

namespace framewatch::drivers {

AccelIntake::AccelIntake(std::vector<WantedAxis> wanted, Sink sink)
    : binding_(wanted), sink_(std::move(sink)), sequence_of_axis_(wanted.size(), nullptr) {}

IntakeResult AccelIntake::message(const std::string& channel, const void* data, std::size_t size) {
  ++counters_.messages;
  IntakeResult result = IntakeResult::foreign;
  if (binding_.carries(channel))
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
  return binding_.carries(stream) ? IntakeResult::table : IntakeResult::foreign;
}

IntakeResult AccelIntake::accel(const std::string& channel, const void* data, std::size_t size) {
  const std::optional<NodeSample> sample = decode_accel(data, size);
  if (!sample) return IntakeResult::malformed;
  const ChannelBinding::NodeAxes* axes = binding_.axes_of(channel, sample->node);
  if (axes == nullptr) return IntakeResult::foreign;
  SequenceCounter& sequence = sequences_[{channel, sample->node}];
  const bool is_new = sequence.see(sample->sequence, to_microseconds(sample->time)) !=
                      SequenceCounter::Verdict::duplicate;
  for (std::size_t i = 0; i < axes->size(); ++i) {
    const int axis = (*axes)[i];
    if (axis == ChannelBinding::kNone) continue;
    sequence_of_axis_[static_cast<std::size_t>(axis)] = &sequence;
    if (is_new) sink_({sample->time, axis, sample->accel_abs_mps2[i]});
  }
  return is_new ? IntakeResult::samples : IntakeResult::duplicate;
}

std::int64_t AccelIntake::lost() const {
  return std::accumulate(sequences_.begin(), sequences_.end(), std::int64_t{0},
                         [](auto sum, const auto& node) { return sum + node.second.lost; });
}

std::int64_t AccelIntake::backwards() const {
  return std::accumulate(sequences_.begin(), sequences_.end(), std::int64_t{0},
                         [](auto sum, const auto& node) { return sum + node.second.backwards; });
}

}  // namespace framewatch::drivers
