#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "drivers/base/sequence_counter.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/axis_binding.h"

namespace framewatch::drivers {

/// What a message turned out to be.
enum class IntakeResult { samples, table, foreign, malformed, duplicate };

struct IntakeCounters {
  std::int64_t messages = 0;
  std::int64_t foreign = 0;    ///< other people's channels, nodes that are not configured
  std::int64_t malformed = 0;  ///< wrong size, fingerprint or lengths on a channel of ours
  std::int64_t duplicate = 0;
};

/// Turns LCM messages, live or from a log, into samples of the configured axes. Never throws on
/// any bytes; counts what it does not take.
class AccelIntake {
 public:
  using Sink = std::function<void(const estimator::AccelSample&)>;

  AccelIntake(std::vector<WantedAxis> wanted, Sink sink);

  IntakeResult message(const std::string& channel, const void* data, std::size_t size);

  const AxisBinding& binding() const { return binding_; }
  const IntakeCounters& counters() const { return counters_; }
  /// By sensor axis: the counters of the node that carries it, null before its first message.
  const SequenceCounter* sequence_of(std::size_t axis) const { return sequence_of_axis_[axis]; }
  std::int64_t lost() const { return lost_; }            ///< messages, summed over the nodes
  std::int64_t backwards() const { return backwards_; }  ///< likewise

  /// What the last message that was `samples` held, and the number of its node among those seen.
  const SensorNodeSample& last_sample() const { return last_sample_; }
  std::size_t last_node() const { return last_node_; }

  /// State (estimator/state/archive.h): what the numbering of messages was and which tables came.
  template <typename Archive>
  void archive(Archive& a) {
    a(counters_.messages, counters_.foreign, counters_.malformed, counters_.duplicate);
    a(lost_, backwards_, binding_);
    using Named = std::pair<std::pair<std::string, std::int32_t>, Sequence>;
    std::vector<Named> sequences(sequences_.begin(), sequences_.end());
    sequences.resize(a.count(sequences.size()));
    for (auto& [place, s] : sequences) a(place.first, place.second, s.counter, s.order);
    std::vector<std::int64_t> of_axis;  // numbers among them
    for (const SequenceCounter* counter : sequence_of_axis_) of_axis.push_back(number_of(counter));
    a(of_axis);
    if constexpr (!Archive::kReading) return;
    sequences_ = {sequences.begin(), sequences.end()};
    for (std::size_t i = 0; i < sequence_of_axis_.size() && i < of_axis.size(); ++i)
      sequence_of_axis_[i] = counter_of(of_axis[i]);
    stream_.clear();  // found again at the next message
    nodes_.clear();
  }

 private:
  /// A node on a stream of ours, as it was found: looked up once.
  struct Node {
    std::int32_t number;
    AxisBinding::NodeAxes axes;
    SequenceCounter* sequence;
    std::size_t order;
  };
  IntakeResult table(const std::string& stream, const void* data, std::size_t size);
  IntakeResult accel(const std::string& channel, const void* data, std::size_t size);
  bool carried(const std::string& channel);
  const Node* find_node(const std::string& channel, std::int32_t number);
  /// A counter's number in the order of sequences_, -1 for null, and back.
  std::int64_t number_of(const SequenceCounter* counter) const;
  const SequenceCounter* counter_of(std::int64_t number) const;

  AxisBinding binding_;
  Sink sink_;
  IntakeCounters counters_;
  struct Sequence {
    SequenceCounter counter;
    std::size_t order = 0;
  };
  std::map<std::pair<std::string, std::int32_t>, Sequence> sequences_;
  std::int64_t lost_ = 0, backwards_ = 0;
  std::string stream_;       ///< of the last message of ours; empty when there was none
  std::vector<Node> nodes_;  ///< of stream_, in the order they came
  std::size_t next_node_ = 0;
  SensorNodeSample last_sample_{};
  std::size_t last_node_ = 0;
  std::vector<const SequenceCounter*> sequence_of_axis_;
};

}  // namespace framewatch::drivers
