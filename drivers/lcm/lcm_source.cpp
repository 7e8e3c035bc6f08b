#include "drivers/lcm/lcm_source.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/core.h>

namespace framewatch::drivers {
namespace {

std::string with_receive_buffer(const std::string& url, int bytes) {
  if (!url.starts_with("udpm://") || url.find("recv_buf_size=") != std::string::npos) return url;
  return fmt::format("{}{}recv_buf_size={}", url, url.find('?') == std::string::npos ? '?' : '&',
                     bytes);
}

/// LCM takes channel names as regular expressions.
std::string literally(const std::string& channel) {
  std::string pattern;
  for (const char c : channel) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_') pattern += '\\';
    pattern += c;
  }
  return pattern;
}

/// What keeps udpm:// from starting, as far as a socket of our own can tell.
std::string why_no_multicast(const std::string& url) {
  std::string group = url.substr(7, url.find_first_of(":?", 7) - 7);
  if (group.empty()) group = "239.255.76.67";
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(7667);
  if (::inet_pton(AF_INET, group.c_str(), &address.sin_addr) != 1 ||
      !IN_MULTICAST(ntohl(address.sin_addr.s_addr)))
    return fmt::format("{} is no multicast address (224.0.0.0 to 239.255.255.255)", group);
  const int probe = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool routed = probe >= 0 && ::connect(probe, reinterpret_cast<const sockaddr*>(&address),
                                              sizeof address) == 0;
  const int failure = errno;
  if (probe >= 0) ::close(probe);
  if (routed)
    return "there is a route to it, so something else is wrong: a port or option LCM does not "
           "know, "
           "or a port that another program holds alone";
  if (failure != ENETUNREACH) return std::strerror(failure);
  return fmt::format(
      "this machine has no multicast route to {0}.\n"
      "Give it one on the loopback:  sudo ip link set lo up && sudo ip route add {0}/32 dev lo",
      group);
}

}  // namespace

std::unique_ptr<lcm::LCM> open_lcm(const std::string& url, int receive_buffer_bytes,
                                   std::string& error) {
  auto lcm = std::make_unique<lcm::LCM>(with_receive_buffer(url, receive_buffer_bytes));
  if (lcm->good()) return lcm;
  if (!url.starts_with("udpm://")) {
    error = fmt::format("LCM cannot start on \"{}\": unknown provider or nothing there", url);
    return nullptr;
  }
  error = fmt::format("LCM cannot start on \"{}\": {}", url, why_no_multicast(url));
  return nullptr;
}

LcmSource::LcmSource(lcm::LCM& lcm, const std::vector<std::string>& channels, int queue_capacity,
                     Handler handler)
    : lcm_(lcm), capacity_(queue_capacity), handler_(std::move(handler)) {
  for (const std::string& channel : channels) {
    lcm::Subscription* subscription =
        lcm_.subscribe(literally(channel), &LcmSource::on_message, this);
    if (subscription == nullptr) continue;
    subscription->setQueueCapacity(queue_capacity);
    subscriptions_.push_back(subscription);
  }
}

LcmSource::~LcmSource() {
  for (lcm::Subscription* subscription : subscriptions_) lcm_.unsubscribe(subscription);
}

bool LcmSource::handle(int timeout_ms) {
  int handled = lcm_.handleTimeout(0);
  if (handled == 0) {
    backlog_ = 0;
    handled = lcm_.handleTimeout(timeout_ms);
  }
  for (std::int64_t i = 1; handled > 0 && i < capacity_; ++i) {
    handled = lcm_.handleTimeout(0);
    if (handled == 0) backlog_ = 0;
  }
  return handled >= 0;
}

void LcmSource::on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  backlog_ = std::min(backlog_ + 1, capacity_);
  backlog_high_water_ = std::max(backlog_high_water_, backlog_);
  handler_(channel, buffer->data, buffer->data_size, buffer->recv_utime);
}

}  // namespace framewatch::drivers
