#include "daemon/web/web_socket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <random>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

constexpr int kWaiting = 64;  // connections not yet accepted

}  // namespace

int listen_on(const std::string& address, int port, std::string& error) {
  sockaddr_in v4{};
  sockaddr_in6 v6{};
  v4.sin_family = AF_INET;
  v6.sin6_family = AF_INET6;
  v4.sin_port = v6.sin6_port = htons(static_cast<std::uint16_t>(port));
  const bool six = address.find(':') != std::string::npos;
  void* to = six ? static_cast<void*>(&v6.sin6_addr) : static_cast<void*>(&v4.sin_addr);
  if (::inet_pton(six ? AF_INET6 : AF_INET, address.c_str(), to) != 1) {
    error = address + ": is no IP address";
    return -1;
  }
  const int socket = ::socket(six ? AF_INET6 : AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  const sockaddr* at =
      six ? reinterpret_cast<const sockaddr*>(&v6) : reinterpret_cast<const sockaddr*>(&v4);
  if (socket >= 0 && ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
      ::bind(socket, at, six ? sizeof v6 : sizeof v4) == 0 && ::listen(socket, kWaiting) == 0)
    return socket;
  error = fmt::format("{} port {}: {}", address, port, std::strerror(errno));
  if (socket >= 0) ::close(socket);
  return -1;
}

std::string page_address(const WebSettings& settings, int port, const std::string& token) {
  const bool six = settings.address.find(':') != std::string::npos;
  return fmt::format("http://{}{}{}:{}/{}", six ? "[" : "", settings.address, six ? "]" : "", port,
                     token.empty() ? "" : "?token=" + token);
}

std::string random_token() {
  std::random_device source;
  std::string out;
  for (int i = 0; i < 4; ++i) out += fmt::format("{:08x}", source());
  return out;
}

}  // namespace framewatch::daemon
