#include "drivers/lcm/multicast/lcm_sender.h"

#include <fmt/core.h>

namespace framewatch::drivers {

std::string to_text(const LcmSender& sender) {
  const std::uint32_t a = sender.address;
  return fmt::format("{}.{}.{}.{}:{}", a >> 24, a >> 16 & 255, a >> 8 & 255, a & 255, sender.port);
}

}  // namespace framewatch::drivers
