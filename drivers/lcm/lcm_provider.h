#pragma once

#include <memory>
#include <optional>
#include <string>

#include <lcm/lcm-cpp.hpp>

#include "drivers/lcm/lcm_reception.h"
#include "drivers/lcm/multicast/multicast_socket.h"

namespace framewatch::drivers {

/// One LCM provider. liblcm publishes; of udpm:// framewatch receives by itself (LcmSource),
/// because liblcm's receiver believes the lengths in a packet and takes packets from everywhere.
class LcmProvider : public lcm::LCM {
 public:
  explicit LcmProvider(const std::string& url, const LcmReception& reception = {});

  /// The group of a udpm:// provider, else empty.
  const std::optional<MulticastGroup>& group() const { return group_; }

 private:
  std::optional<MulticastGroup> group_;
};

/// Null, with the reason and the remedy in `error`, when LCM cannot start there.
std::unique_ptr<LcmProvider> open_lcm(const std::string& url, const LcmReception& reception,
                                      std::string& error);

}  // namespace framewatch::drivers
