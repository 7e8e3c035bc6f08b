// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace framewatch::drivers {

/// Chooses the senders of a udpm:// provider; other providers ignore it.
struct LcmReception {
  std::vector<std::string> interfaces{"lo"};  ///< see MulticastGroup
  int receive_buffer_bytes = 4194304;
};

/// Chooses whose samples count while two send under one node.
enum class TwoSenders { first, none };

/// Settings of AccelIntake.
struct IntakeSettings {
  double rate_hz = 0;  ///< of every node; 0: unknown, then only addresses tell senders apart
  TwoSenders two_senders = TwoSenders::first;
};

}  // namespace framewatch::drivers
