// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/acknowledge.h"

#include <charconv>
#include <system_error>
#include <utility>

#include <fmt/core.h>
#include <lcm/lcm-cpp.hpp>

#include <framewatch/event_t.hpp>

#include "daemon/base/printable.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/events/event_messages.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxComment = 500;  // bytes
constexpr int kMaxAnswered = 200;         // events, so that the answer fits into a packet
constexpr const char* kNobodyKnown = "LCM";

constexpr int kRefused = 1, kUnreachable = 2;

/// Returns the number of an event, 0 for "all", and nullopt for any other text.
std::optional<std::int64_t> number_of(const std::string& event) {
  if (event == "all") return 0;
  std::int64_t id = 0;
  const char* const end = event.data() + event.size();
  const auto [at, error] = std::from_chars(event.data(), end, id);
  if (error != std::errc() || at != end || id == 0) return std::nullopt;
  return id;
}

int stop(int code, const std::string& why) {
  fmt::print(stderr, "framewatch acknowledge: {}\n", printable(why));
  return code;
}

}  // namespace

AcknowledgeDesk::AcknowledgeDesk(const Config& config, lcm::LCM& lcm, Done done)
    : config_(config), lcm_(lcm), done_(std::move(done)) {}

void AcknowledgeDesk::acknowledge(const acknowledge_t& request, const std::string& user,
                                  const Raised& raised, std::int64_t now_us) {
  if (request.request == answered_) return;
  const Acknowledgement by{now_us, who_text(user, request.who),
                           printable(request.comment, kMaxComment)};
  if (request.id == kAllEvents) all_ = by;
  bool any = false;
  for (RaisedEvents* events : raised)
    for (const event_t& e : events->all()) {
      if (request.id != kAllEvents && request.id != e.id) continue;
      any = true;
      if (request.id == kAllEvents && events->acknowledgement(e.id) != nullptr) continue;
      events->acknowledge(e.id, by);
      log(LogLevel::notice, fmt::format("event {} ({} {}) is acknowledged by {}: {}", e.id, e.kind,
                                        e.place, by.who, by.comment));
      done_(e, by);
    }
  answered_ = request.request;
  refused_ = any                        ? ""
             : request.id == kAllEvents ? "no event is raised"
                                        : fmt::format("no event {} is raised", request.id);
  news_ = true;
}

std::optional<acknowledged_t> AcknowledgeDesk::obey(std::span<const std::uint8_t> bytes,
                                                    const std::string& user, const Raised& raised,
                                                    std::int64_t now_us) {
  const auto request = drivers::decoded<acknowledge_t>(bytes);
  if (!request) return std::nullopt;
  acknowledge(*request, user, raised, now_us);
  acknowledged_t out{};
  out.time_us = now_us;
  out.answered = answered_;
  out.refused = refused_;
  for (const RaisedEvents* events : raised)
    for (const event_t& e : events->all()) {
      const Acknowledgement* by = events->acknowledgement(e.id);
      const bool meant = request->id == kAllEvents || request->id == e.id;
      if (by == nullptr || !meant || out.events == kMaxAnswered) continue;
      add_acknowledged(out, e, {by->time_us, by->who, ""});
    }
  return out;
}

void AcknowledgeDesk::heard(std::span<const std::uint8_t> bytes, std::int64_t now_us) {
  if (!config_.lcm.commands) {
    ++not_obeyed_;
    return warnings_(now_us,
                     fmt::format("ignored {} commands over LCM so far (lcm.commands = false): "
                                 "use framewatch acknowledge",
                                 not_obeyed_));
  }
  auto request = drivers::decoded<acknowledge_t>(bytes);
  if (request && requests_.size() < kMaxRequests) requests_.push_back(std::move(*request));
}

void AcknowledgeDesk::update(const Raised& raised, std::int64_t now_us) {
  const std::vector<acknowledge_t> requests = std::exchange(requests_, {});
  for (const acknowledge_t& request : requests) acknowledge(request, kNobodyKnown, raised, now_us);
  const bool due = second_.due(now_us);
  if (!std::exchange(news_, false) && requests.empty() && !due) return;
  acknowledged_t out{};
  out.time_us = now_us;
  out.answered = answered_;
  out.refused = refused_;
  for (const RaisedEvents* events : raised)
    for (const event_t& e : events->all())
      if (const Acknowledgement* by = events->acknowledgement(e.id)) add_acknowledged(out, e, *by);
  if (all_) add_all_acknowledged(out, *all_);
  lcm_.publish(config_.lcm.prefix + "ACKNOWLEDGED", &out);
}

std::optional<acknowledged_t> ask_daemon(const Config& config, const CommandPacket& command,
                                         RefusedCommand& refused) {
  const CommandAnswer answer = give_command(config, "run", command);
  auto done = drivers::decoded<acknowledged_t>(answer.bytes);
  if (!answer.answered)
    refused = {kUnreachable, answer.problem};
  else if (!answer.problem.empty())
    refused = {kRefused, answer.problem};
  else if (!done)
    refused = {kUnreachable, "cannot read the daemon's answer: is it another version?"};
  else if (!done->refused.empty())
    refused = {kRefused, done->refused};
  else
    return done;
  return std::nullopt;
}

int acknowledge_command(const AcknowledgeArguments& a) {
  std::vector<ConfigProblem> problems;
  const std::optional<Config> config = load_config(a.config, problems);
  print_problems(problems);
  const std::optional<std::int64_t> id = number_of(a.event);
  if (!id)
    (void)stop(kUnreachable,
               fmt::format("'{}' is not the number of an event, and not all", a.event));
  if (!config || !id) return kUnreachable;
  const acknowledge_t request = acknowledge_request(*id, a.who, a.comment);
  RefusedCommand refused;
  const auto done = ask_daemon(*config, {"ACKNOWLEDGE", drivers::encoded(request)}, refused);
  if (!done) return stop(refused.exit_code, refused.why);
  for (std::size_t i = 0; i < done->id.size(); ++i)
    fmt::print("{}\n", printable(fmt::format("{} {} ({}) is acknowledged by {}", done->kind[i],
                                             done->place[i], done->id[i], done->who[i])));
  return 0;
}

}  // namespace framewatch::daemon
