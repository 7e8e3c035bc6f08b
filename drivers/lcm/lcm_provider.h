// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <lcm/lcm-cpp.hpp>

#include "drivers/lcm/lcm_settings.h"
#include "drivers/lcm/multicast/multicast_socket.h"

namespace framewatch::drivers {

/// One LCM provider. liblcm publishes. framewatch itself receives udpm:// (LcmSource), because the
/// receiver of liblcm trusts the lengths in a packet and accepts packets from everywhere.
class LcmProvider : public lcm::LCM {
 public:
  explicit LcmProvider(const std::string& url, const LcmReception& reception = {});

  /// Returns the group of a udpm:// provider; nullopt for other providers.
  const std::optional<MulticastGroup>& group() const { return group_; }

 private:
  std::optional<MulticastGroup> group_;
};

/// Opens a provider. Returns null and sets `error`, with the remedy, when LCM cannot start there.
std::unique_ptr<LcmProvider> open_lcm(const std::string& url, const LcmReception& reception,
                                      std::string& error);

}  // namespace framewatch::drivers
