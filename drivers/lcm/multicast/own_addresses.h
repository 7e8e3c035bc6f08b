#pragma once

#include <cstdint>
#include <set>

namespace framewatch::drivers {

/// The IPv4 addresses of this machine. Linux refuses packets from outside that pretend to come from
/// one of them.
class OwnAddresses {
 public:
  OwnAddresses() { read(); }
  /// address: host byte order. now_us: any clock; addresses that are new are found within a second.
  bool has(std::uint32_t address, std::int64_t now_us);

 private:
  void read();

  std::set<std::uint32_t> addresses_;
  std::int64_t read_us_ = 0;
};

}  // namespace framewatch::drivers
