// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "drivers/lcm/accel_codec.h"

namespace framewatch::test {

/// The sensor nodes of the example building, in motion: two messages an instant.
class ShakenNodes {
 public:
  template <typename Take>
  void shake(int instants, const Take& take) {
    for (int i = 0; i < instants; ++i, ++instant_)
      for (const std::int32_t node : {0, 1}) {
        const auto t = static_cast<double>(instant_) / 50;
        const double wave = std::sin(19 * t) + 0.3 * std::sin(7 * t + node);
        take(drivers::encode_accel({estimator::from_microseconds(1'000'000 + 20'000 * instant_),
                                    instant_,
                                    node,
                                    {(1 + node) * wave, wave, -wave}}));
      }
  }

 private:
  std::int64_t instant_ = 0;
};

}  // namespace framewatch::test
