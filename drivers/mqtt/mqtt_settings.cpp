// SPDX-License-Identifier: MIT
#include "drivers/mqtt/mqtt_settings.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string_view>
#include <system_error>

namespace framewatch::drivers {
namespace {

constexpr std::string_view kPlain = "mqtt://", kTls = "mqtts://";
constexpr int kPlainPort = 1883, kTlsPort = 8883, kMostPort = 65535;
constexpr std::size_t kLongestHost = 253;

/// Returns the port, or nullopt if the text is not a number from 1 to 65535.
std::optional<int> read_port(std::string_view text) {
  int port = 0;
  const char* const end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(text.data(), end, port);
  if (error != std::errc() || parsed != end || port < 1 || port > kMostPort) return std::nullopt;
  return port;
}

bool is_host(std::string_view host, bool bracketed) {
  const auto allowed = [bracketed](char c) {
    const bool alphanumeric =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    return alphanumeric || c == '.' || (bracketed ? c == ':' || c == '%' : c == '-' || c == '_');
  };
  return !host.empty() && host.size() <= kLongestHost && std::ranges::all_of(host, allowed);
}

}  // namespace

std::optional<MqttAddress> mqtt_address(const std::string& url) {
  MqttAddress out;
  out.tls = url.starts_with(kTls);
  if (!out.tls && !url.starts_with(kPlain)) return std::nullopt;
  std::string_view rest = std::string_view(url).substr(out.tls ? kTls.size() : kPlain.size());
  if (rest.ends_with('/')) rest.remove_suffix(1);
  const bool bracketed = rest.starts_with('[');
  const std::size_t end = bracketed ? rest.find(']') : std::min(rest.find(':'), rest.size());
  if (end == std::string_view::npos) return std::nullopt;
  out.host = rest.substr(bracketed ? 1 : 0, bracketed ? end - 1 : end);
  rest.remove_prefix(bracketed ? end + 1 : end);
  if (!is_host(out.host, bracketed)) return std::nullopt;
  out.port = out.tls ? kTlsPort : kPlainPort;
  if (rest.empty()) return out;
  const std::optional<int> port = rest.front() == ':' ? read_port(rest.substr(1)) : std::nullopt;
  if (!port) return std::nullopt;
  out.port = *port;
  return out;
}

bool is_this_machine(const MqttAddress& address) {
  return address.host == "localhost" || address.host == "::1" || address.host.starts_with("127.");
}

}  // namespace framewatch::drivers
