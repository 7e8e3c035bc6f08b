#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "drivers/lcm/channel_table.h"
#include "drivers/lcm/multicast/lcm_sender.h"
#include "drivers/lcm/sequence_watch.h"

namespace framewatch::drivers {

/// Trouble with a node's messages or with a channel table, when it begins and when it is over.
struct IntakeNotice {
  bool of_table = false;  ///< a table contradicts the binding of `axis`; else `trouble` of a node
  SequenceTrouble trouble = SequenceTrouble::two_senders;
  std::size_t axis = 0;  ///< sensor axis; of a node the first one it carries
  bool over = false;
  std::int64_t arrival_us = 0;
  std::string stream;              ///< LCM channel of the samples
  std::int32_t node = 0;           ///< that sends them
  std::int64_t count = 0, of = 0;  ///< of a node: messages of the last 10 s, and all of them
  LcmSender bound, other;          ///< two_senders: where both are known
  std::int64_t from = 0, to = 0;   ///< leaps: the newest one
  ChannelTable::Entry told;        ///< of a table: what it says
};

using IntakeNoticeSink = std::function<void(const IntakeNotice&)>;

}  // namespace framewatch::drivers
