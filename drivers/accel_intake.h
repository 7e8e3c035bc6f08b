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
  std::int64_t lost() const;       ///< messages, summed over the nodes
  std::int64_t backwards() const;  ///< likewise

 private:
  IntakeResult table(const std::string& stream, const void* data, std::size_t size);
  IntakeResult accel(const std::string& channel, const void* data, std::size_t size);

  ChannelBinding binding_;
  Sink sink_;
  IntakeCounters counters_;
  std::map<std::pair<std::string, std::int32_t>, SequenceCounter> sequences_;
  std::vector<const SequenceCounter*> sequence_of_axis_;
};

}  // namespace framewatch::drivers
