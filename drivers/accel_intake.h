#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "drivers/accel_codec.h"
#include "drivers/channel_binding.h"
#include "drivers/sequence_counter.h"

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
  using Sink = std::function<void(const AccelSample&)>;

  AccelIntake(std::vector<WantedAxis> wanted, Sink sink);

  IntakeResult message(const std::string& channel, const void* data, std::size_t size);

  const ChannelBinding& binding() const { return binding_; }
  const IntakeCounters& counters() const { return counters_; }
  /// By sensor axis: the counters of the node that carries it, null before its first message.
  const SequenceCounter* sequence_of(std::size_t axis) const { return sequence_of_axis_[axis]; }
  std::int64_t lost() const { return lost_; }            ///< messages, summed over the nodes
  std::int64_t backwards() const { return backwards_; }  ///< likewise

  /// What the last message that was `samples` held, and the number of its node among those seen.
  const NodeSample& last_sample() const { return last_sample_; }
  std::size_t last_node() const { return last_node_; }

 private:
  /// A node on a stream of ours, as it was found: looked up once.
  struct Node {
    std::int32_t number;
    ChannelBinding::NodeAxes axes;
    SequenceCounter* sequence;
    std::size_t order;
  };
  IntakeResult table(const std::string& stream, const void* data, std::size_t size);
  IntakeResult accel(const std::string& channel, const void* data, std::size_t size);
  bool carried(const std::string& channel);
  const Node* find_node(const std::string& channel, std::int32_t number);

  ChannelBinding binding_;
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
  NodeSample last_sample_{};
  std::size_t last_node_ = 0;
  std::vector<const SequenceCounter*> sequence_of_axis_;
};

}  // namespace framewatch::drivers
