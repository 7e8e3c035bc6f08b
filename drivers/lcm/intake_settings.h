#pragma once

namespace framewatch::drivers {

/// Which samples go on while two send under one node.
enum class TwoSenders { first, none };

struct IntakeSettings {
  double rate_hz = 0;  ///< of every node; 0: not known, then senders are told by address alone
  TwoSenders two_senders = TwoSenders::first;
};

}  // namespace framewatch::drivers
