// SPDX-License-Identifier: MIT
#include "fleet/uplink/command_desk.h"

#include <algorithm>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/base/printable.h"
#include "drivers/files/number_text.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::fleet {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestRequest = 64, kLongestWho = 128, kMaxChannels = 1000;
constexpr std::int64_t kFarthest_us = 3600 * daemon::kSecond_us;  // of Fw-Until
constexpr std::int64_t kLongestRaw_us = daemon::kDay_us;
constexpr std::int64_t kLongestOther_us = 400 * daemon::kDay_us;
constexpr std::int64_t kLatest_us = INT64_MAX / 4;

std::string answer(const std::string& why) {
  json out{{"ok", why.empty()}};
  if (!why.empty()) out["why"] = why;
  return out.dump(-1, ' ', true, json::error_handler_t::replace);
}

/// A request id is also a file name.
bool is_request(const std::string& request) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  };
  return !request.empty() && request.size() <= kLongestRequest &&
         std::all_of(request.begin(), request.end(), allowed);
}

/// Returns the time range of a command. Returns nullopt and sets `why` if it is missing or invalid.
std::optional<TimeRange> range_of(const json& document, std::int64_t longest_us, std::string& why) {
  TimeRange out;
  if (!document.is_object()) {
    why = "expected a JSON object with from_us and to_us";
    return std::nullopt;
  }
  for (const auto& [name, value] : {std::pair("from_us", &out.from_us), {"to_us", &out.to_us}}) {
    const auto found = document.find(name);
    if (found == document.end() || !found->is_number_integer()) {
      why = fmt::format("{} must be a whole number of us since 1970", name);
      return std::nullopt;
    }
    *value = found->get<std::int64_t>();
  }
  if (out.from_us < -kLatest_us || out.to_us > kLatest_us || out.from_us >= out.to_us ||
      out.to_us - out.from_us > longest_us) {
    why = fmt::format("to_us must be after from_us, by {:.0f} s at most",
                      1e-6 * static_cast<double>(longest_us));
    return std::nullopt;
  }
  return out;
}

json document_of(const Message& command) {
  return json::parse(command.bytes.begin(), command.bytes.end(), nullptr, false);
}

}  // namespace

std::string CommandDesk::obey(std::string_view verb, const Message& command, std::int64_t host_us) {
  if (verb == "ping") return answer("");
  const std::string who = command.header(header::kWho), request = command.header(header::kRequest);
  const auto refuse = [&](const std::string& why) {
    ++refused_;
    return answer(why);
  };
  if (std::string why = check(verb, command, host_us); !why.empty()) {
    warnings_(host_us, daemon::printable(fmt::format("the hub's command {} by '{}' is refused: {}",
                                                     verb, who.substr(0, kLongestWho), why)));
    return refuse(why);
  }
  if (const auto before = store_.journal(request))
    return answer(before->outcome.starts_with("done") ? "" : before->outcome);
  if (!store_.note({request, std::string(verb), who, host_us, "begun"}))
    return refuse("cannot write the journal: " + store_.error());
  const std::string why = carry_out(verb, command);
  (void)store_.conclude(request, why.empty() ? "done" : why);
  daemon::log(daemon::LogLevel::notice,
              daemon::printable(fmt::format("the hub's command {} by {}: {}", verb, who,
                                            why.empty() ? "done" : why)));
  if (!why.empty()) return refuse(why);
  ++obeyed_;
  return answer("");
}

std::string CommandDesk::check(std::string_view verb, const Message& command,
                               std::int64_t host_us) const {
  const auto& accept = settings_.accept;
  if (std::find(accept.begin(), accept.end(), verb) == accept.end())
    return "this building does not accept this command ([fleet] accept)";
  if (command.bytes.size() > kMaxBytes)
    return fmt::format("a command may have at most {} bytes", kMaxBytes);
  if (!is_request(command.header(header::kRequest)))
    return "Fw-Request must be 1 to 64 of a-z, 0-9 and -";
  const std::string who = command.header(header::kWho);
  if (who.empty() || who.size() > kLongestWho)
    return "Fw-Who must name the person in at most 128 bytes";
  const auto until = drivers::parse_integer(command.header(header::kUntil));
  if (!until || *until > kLatest_us / daemon::kSecond_us || *until < 0)
    return "Fw-Until must be a time in s since 1970";
  const std::int64_t left_us = *until * daemon::kSecond_us - host_us;
  if (left_us < 0)
    return fmt::format("the command came {:.0f} s too late by the building's clock",
                       -1e-6 * static_cast<double>(left_us));
  if (left_us > kFarthest_us) return "Fw-Until is more than an hour ahead of the building's clock";
  return {};
}

std::string CommandDesk::carry_out(std::string_view verb, const Message& command) {
  if (verb == "acknowledge") return acknowledge(command);
  if (verb == "raw") return raw(command);
  std::string why;
  const auto time = range_of(document_of(command), kLongestOther_us, why);
  if (!time) return why;
  const bool stored = verb == "resend" ? store_.forget_between(*time) : store_.want_minutes(*time);
  if (!stored) return "cannot store the command: " + store_.error();
  changed_ = true;
  return {};
}

/// Replaces the author in the message with the person who gave the command.
std::string CommandDesk::acknowledge(const Message& command) {
  auto request = drivers::decoded<acknowledge_t>(command.bytes);
  if (!request) return "expected an acknowledge_t";
  request->who = command.header(header::kWho);
  return acknowledge_(*request);
}

std::string CommandDesk::raw(const Message& command) {
  std::string why;
  const json document = document_of(command);
  const auto time = range_of(document, kLongestRaw_us, why);
  if (!time) return why;
  RawRequest request{command.header(header::kRequest), *time, {}, kMaxRaw_bytes};
  if (const auto bytes = document.find("bytes"); bytes != document.end()) {
    if (!bytes->is_number_integer() || bytes->get<std::int64_t>() < 1)
      return "bytes must be a whole number above 0";
    request.most_bytes = std::min(request.most_bytes, bytes->get<std::int64_t>());
  }
  if (const auto channels = document.find("channels"); channels != document.end()) {
    if (!channels->is_array() || channels->size() > kMaxChannels)
      return "channels must be a list of names";
    for (const json& name : *channels) {
      if (!name.is_string()) return "channels must be a list of names";
      request.channels.push_back(name.get<std::string>());
    }
  }
  if (store_.raw_requests().size() >= kMaxRaw)
    return fmt::format("{} requests for raw samples are open already", kMaxRaw);
  return store_.add_raw(request) ? "" : "cannot store the command: " + store_.error();
}

}  // namespace framewatch::fleet
