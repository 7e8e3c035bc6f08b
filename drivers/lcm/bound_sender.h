#pragma once

#include <cstdint>

#include "drivers/lcm/multicast/lcm_sender.h"

namespace framewatch::drivers {

/// The address that a node's messages come from: the first one that sent, until it is silent for
/// kSilent_us. A node that begins anew has another port.
class BoundSender {
 public:
  static constexpr std::int64_t kSilent_us = 2'000'000;
  static constexpr std::int64_t kHold_us = 5'000'000;

  /// Whether the message is of the bound address; always, where nobody tells the sender.
  bool takes(const LcmSender& sender, std::int64_t arrival_us);
  /// Whether two addresses have sent side by side within the last kHold_us.
  bool contested(std::int64_t arrival_us) const { return arrival_us < contested_until_us_; }
  const LcmSender& bound() const { return bound_; }
  /// The newest other one.
  const LcmSender& other() const { return other_; }

  std::int64_t others = 0;    ///< messages of other addresses
  std::int64_t contests = 0;  ///< times that the bound one sent after another one

  template <typename Archive>
  void archive(Archive& a) {
    a(bound_.address, bound_.port, other_.address, other_.port, other_was_last_);
    for (std::int64_t* time : {&arrival_us_, &contested_until_us_})
      a.within(*time, -2 * a.kMaxCount, 2 * a.kMaxCount);
    for (std::int64_t* count : {&others, &contests}) a.within(*count, 0, a.kMaxCount);
  }

 private:
  LcmSender bound_, other_;
  std::int64_t arrival_us_ = 0;  ///< of the newest message of the bound one
  std::int64_t contested_until_us_ = 0;
  bool other_was_last_ = false;
};

}  // namespace framewatch::drivers
