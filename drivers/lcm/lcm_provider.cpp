// SPDX-License-Identifier: MIT
#include "drivers/lcm/lcm_provider.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <string_view>
#include <system_error>

#include <fmt/core.h>

namespace framewatch::drivers {
namespace {

constexpr std::string_view kUdpm = "udpm://", kGroup = "239.255.76.67";
constexpr std::uint16_t kPort = 7667;

/// Parses udpm://GROUP:PORT?..., where group and port may be missing. Returns nullopt for any other
/// text.
std::optional<MulticastGroup> group_of(std::string_view url, const LcmReception& reception) {
  if (!url.starts_with(kUdpm)) return std::nullopt;
  std::string_view place = url.substr(kUdpm.size());
  place = place.substr(0, place.find('?'));
  const std::size_t colon = place.find(':');
  const std::string address(place.substr(0, colon));
  in_addr group{};
  if (::inet_pton(AF_INET, address.empty() ? kGroup.data() : address.c_str(), &group) != 1 ||
      !IN_MULTICAST(ntohl(group.s_addr)))
    return std::nullopt;
  std::uint16_t port = kPort;
  if (colon != std::string_view::npos) {
    const std::string_view digits = place.substr(colon + 1);
    const auto [end, why] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
    if (why != std::errc() || end != digits.data() + digits.size() || port == 0)
      return std::nullopt;
  }
  return MulticastGroup{ntohl(group.s_addr), port, reception.interfaces,
                        reception.receive_buffer_bytes};
}

/// Returns why udpm:// cannot start, as far as a probing socket can tell.
std::string why_no_multicast(const std::optional<MulticastGroup>& group) {
  if (!group)
    return "expected a multicast address (224.0.0.0 to 239.255.255.255) and a port (1 to 65535)";
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(group->port);
  address.sin_addr.s_addr = htonl(group->address);
  const Descriptor probe(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (::connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
    return "there is a route to it, so something else is wrong: an option LCM does not know, or a "
           "port that another program uses exclusively";
  if (errno != ENETUNREACH) return std::strerror(errno);
  char text[INET_ADDRSTRLEN] = "";
  ::inet_ntop(AF_INET, &address.sin_addr, text, sizeof text);
  return fmt::format(
      "this machine has no multicast route to {0}.\n"
      "Give it one on the loopback:  sudo ip link set lo up && sudo ip route add {0}/32 dev lo",
      text);
}

}  // namespace

LcmProvider::LcmProvider(const std::string& url, const LcmReception& reception)
    : lcm::LCM(url), group_(group_of(url, reception)) {}

std::unique_ptr<LcmProvider> open_lcm(const std::string& url, const LcmReception& reception,
                                      std::string& error) {
  const bool multicast = url.starts_with(kUdpm);
  const std::string problem = fmt::format("LCM cannot start on \"{}\"", url);
  if (multicast && !group_of(url, reception)) {
    error = fmt::format("{}: {}", problem, why_no_multicast({}));
    return nullptr;
  }
  auto lcm = std::make_unique<LcmProvider>(url, reception);
  if (!lcm->good()) {
    error = multicast ? fmt::format("{}: {}", problem, why_no_multicast(lcm->group()))
                      : fmt::format("{}: unknown provider or nothing there", problem);
    return nullptr;
  }
  if (!multicast) return lcm;
  MulticastSocket probe;
  if (probe.open(*lcm->group(), error)) return lcm;
  error = fmt::format("{}: {}", problem, error);
  return nullptr;
}

}  // namespace framewatch::drivers
