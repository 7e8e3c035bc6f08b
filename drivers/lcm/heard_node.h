#pragma once

#include <cstddef>
#include <cstdint>

#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/bound_sender.h"
#include "drivers/lcm/sequence_counter.h"
#include "drivers/lcm/sequence_watch.h"

namespace framewatch::drivers {

/// What was heard of one sensor node on one LCM channel.
struct HeardNode {
  static constexpr double kMaxNodes = 1e6;  ///< ever heard
  explicit HeardNode(double rate_hz) : counter(rate_hz) {}

  SequenceCounter counter;
  BoundSender sender;
  SequenceWatch watch;
  SensorNodeSample held;      ///< the first after a leap of the numbers
  std::size_t order = 0;      ///< number among the nodes heard
  std::size_t axis = 0;       ///< the first sensor axis it carried
  std::uint8_t in_input = 0;  ///< it was heard in the log that is read
  std::int64_t withheld = 0;  ///< messages of the first of two senders, while none goes on
  std::int64_t unheard = 0;   ///< of the lost ones: nobody listened
  bool away = false;          ///< nobody listened before its next message

  /// Messages that came under the node's number and were left out.
  std::int64_t left_out() const {
    return counter.duplicates + counter.others + sender.others + withheld;
  }
  bool contested(std::int64_t arrival_us) const {
    return counter.contested(arrival_us) || sender.contested(arrival_us);
  }
  SequenceWatch::Counts counts() const {
    return {counter.received, counter.lost - unheard, counter.duplicates, counter.leaps,
            counter.conflicts + counter.others + sender.contests};
  }

  template <typename Archive>
  void archive(Archive& a) {
    a(held.time, held.sequence, held.node, held.accel_abs_mps2);
    a(counter, sender, watch, axis, in_input);
    a.within(order, 0, kMaxNodes);
    a.within(withheld, 0, a.kMaxCount);
    a.within(unheard, 0, a.kMaxCount);
  }
};

}  // namespace framewatch::drivers
