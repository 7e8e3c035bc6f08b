// SPDX-License-Identifier: MIT
#include "daemon/monitor/service/command_socket.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/base/process.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kListenAgain_us = 5'000'000;
constexpr int kMaxAccepts = 64;  // in one poll()

std::string with_errno(const std::string& path) {
  return fmt::format("{}: {}", path, std::strerror(errno));
}

/// Looks the name up in a thread: a slow directory server then delays only this command.
std::future<std::string> name_of(uid_t user) {
  try {
    return std::async(std::launch::async, user_name, user);
  } catch (const std::system_error&) {
    std::promise<std::string> number;
    number.set_value(fmt::format("uid {}", user));
    return number.get_future();
  }
}

}  // namespace

CommandSocket::CommandSocket(const Config& config, const std::string& service, Handler handler)
    : directory_(command_directory(config)),
      path_(command_path(directory_, config, service)),
      service_(service),
      handler_(std::move(handler)),
      buffer_(CommandPacket::kMaxBytes + 1) {
  listen(steady_clock_us());
}

CommandSocket::~CommandSocket() {
  if (problem_.empty()) ::unlink(path_.c_str());
}

void CommandSocket::listen(std::int64_t now_us) {
  if (now_us < next_try_us_) return;
  next_try_us_ = now_us + kListenAgain_us;
  const std::string problem = open();
  if (problem == problem_) return;
  problem_ = problem;
  if (!problem.empty()) log(LogLevel::error, "cannot take commands: " + problem);
}

std::string CommandSocket::open() {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path_.size() >= sizeof address.sun_path)
    return fmt::format(
        "{}: the path of a socket has {} bytes at most: set a shorter [commands] directory", path_,
        sizeof address.sun_path - 1);
  path_.copy(address.sun_path, sizeof address.sun_path - 1);
  std::string problem = prepare_command_directory(directory_);
  if (!problem.empty()) return problem;
  // The holder of the lock listens. The lock file is never removed: otherwise two daemons could
  // hold locks on two files of that name.
  const std::string lock = path_ + ".lock";
  lock_.reset(::open(lock.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (lock_.get() < 0) return with_errno(lock);
  if (::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0)
    return fmt::format(
        "{}: another framewatch {} takes commands there: give each its own lcm.prefix or "
        "[commands] directory",
        path_, service_);
  ::unlink(path_.c_str());  // left by a dead process: this one holds the lock
  socket_.reset(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const auto* const named = reinterpret_cast<const sockaddr*>(&address);
  // Nobody can connect before listen(), so the mode is set in time.
  if (socket_.get() < 0 || ::bind(socket_.get(), named, sizeof address) != 0 ||
      ::chmod(path_.c_str(), 0660) != 0 || ::listen(socket_.get(), kMaxConnections) != 0)
    return with_errno(path_);
  return "";
}

void CommandSocket::poll(std::int64_t now_us) {
  if (!problem_.empty()) listen(now_us);
  if (!problem_.empty()) return;
  accept(now_us);
  for (auto at = connections_.begin(); at != connections_.end();) {
    Next next = at->command.channel.empty() ? receive(*at, now_us) : Next::wait;
    if (!at->command.channel.empty()) next = answer(*at);
    at = next == Next::done ? connections_.erase(at) : std::next(at);
  }
}

void CommandSocket::accept(std::int64_t now_us) {
  for (int i = 0; i < kMaxAccepts && make_room(); ++i) {
    const int file = ::accept4(socket_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (file < 0) return;
    Connection& c = connections_.emplace_back();
    c.file.reset(file);
    c.until_us = now_us + kPatience_us;
    ucred peer{};
    socklen_t size = sizeof peer;
    const bool known = ::getsockopt(file, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0;
    c.user = peer.uid;
    if (!known || receive(c, now_us) == Next::done) connections_.pop_back();
  }
}

bool CommandSocket::make_room() {
  if (connections_.size() < kMaxConnections) return true;
  for (auto at = connections_.begin(); at != connections_.end(); ++at)
    if (at->command.channel.empty()) {
      connections_.erase(at);
      return true;
    }
  return false;
}

CommandSocket::Next CommandSocket::receive(Connection& c, std::int64_t now_us) {
  const ssize_t got = ::recv(c.file.get(), buffer_.data(), buffer_.size(), MSG_DONTWAIT);
  if (got < 0 && (errno == EAGAIN || errno == EINTR))
    return now_us < c.until_us ? Next::wait : Next::done;
  if (got <= 0) return Next::done;
  auto packet = packet_of({buffer_.data(), static_cast<std::size_t>(got)});
  if (!packet) {
    ++malformed_;
    return Next::done;
  }
  c.command = std::move(*packet);
  c.name = name_of(c.user);
  return Next::wait;
}

CommandSocket::Next CommandSocket::answer(Connection& c) {
  if (c.name.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return Next::wait;
  const CommandPacket out = handler_(c.command, c.name.get());
  const std::vector<std::uint8_t> bytes = packet_bytes(out);
  // A client that does not wait gets no answer.
  (void)::send(c.file.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  return Next::done;
}

}  // namespace framewatch::daemon
