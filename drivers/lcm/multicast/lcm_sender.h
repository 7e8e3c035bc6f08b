#pragma once

#include <cstdint>
#include <string>

namespace framewatch::drivers {

/// Who sent a message: IPv4 address and UDP port, host byte order. 0 and 0: the provider does not
/// tell, as memq:// and event logs.
struct LcmSender {
  std::uint32_t address = 0;
  std::uint16_t port = 0;
  friend auto operator<=>(const LcmSender&, const LcmSender&) = default;
};

/// "10.0.0.7:41230".
std::string to_text(const LcmSender& sender);

}  // namespace framewatch::drivers
