// SPDX-License-Identifier: MIT
#include "fleet/serve/commander.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <framewatch/acknowledge_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/printable.h"
#include "daemon/monitor/events/event_messages.h"
#include "drivers/files/encoded.h"
#include "drivers/files/number_text.h"
#include "fleet/message/address.h"

namespace framewatch::fleet {
namespace {

using nlohmann::json;

constexpr std::string_view kCommandVerbs[] = {"ping", "acknowledge", "minutes", "resend", "raw"};
constexpr std::size_t kLongestComment = 500, kLongestChannels = 20'000;

bool put_time(json& out, const CommandWords& words, std::string& why) {
  const auto from = drivers::parse_integer(words.from_us), to = drivers::parse_integer(words.to_us);
  if (!from || !to || *from >= *to) {
    why = "from_us and to_us must be whole numbers of us since 1970, to_us after from_us";
    return false;
  }
  out["from_us"] = *from;
  out["to_us"] = *to;
  return true;
}

constexpr std::size_t kLongestAnswer = 500, kMaxBytes = 65'536;
constexpr const char* kNobody = "503";

/// Returns why the building did not obey; empty if it did.
std::string answer_of(const Message& message) {
  if (message.header(header::kStatus) == kNobody) return "the building is not connected";
  if (message.bytes.size() > kMaxBytes) return "the building's answer is too long";
  const auto document =
      nlohmann::json::parse(message.bytes.begin(), message.bytes.end(), nullptr, false);
  if (!document.is_object() || !document.contains("ok") || !document["ok"].is_boolean())
    return "the building's answer is malformed";
  if (document["ok"].get<bool>()) return {};
  const auto why = document.find("why");
  const std::string text = why != document.end() && why->is_string() ? why->get<std::string>() : "";
  return text.empty() ? "refused" : daemon::printable(text.substr(0, kLongestAnswer));
}

}  // namespace

std::optional<std::string> command_content(const CommandWords& words, std::string& why) {
  json out = json::object();
  if (std::find(std::begin(kCommandVerbs), std::end(kCommandVerbs), words.verb) ==
      std::end(kCommandVerbs)) {
    why = "verb must be ping, acknowledge, minutes, resend or raw";
    return std::nullopt;
  }
  if (words.verb == "acknowledge") {
    const auto id = drivers::parse_integer(words.id);
    if (!id || *id == 0 || words.comment.size() > kLongestComment) {
      why = "id must be the id of an event, and comment at most 500 bytes";
      return std::nullopt;
    }
    out["id"] = *id;
    if (!words.comment.empty()) out["comment"] = words.comment;
  } else if (words.verb != "ping" && !put_time(out, words, why)) {
    return std::nullopt;
  }
  if (words.verb == "raw" && !words.channels.empty()) {
    if (words.channels.size() > kLongestChannels) {
      why = "too many channels";
      return std::nullopt;
    }
    std::vector<std::string_view> names;
    drivers::split_commas(words.channels, names);
    out["channels"] = names;
  }
  return out.dump(-1, ' ', true, json::error_handler_t::replace);
}

Message command_message(const CommandOrder& order, const std::string& building,
                        const std::string& reply, std::int64_t until_us) {
  Message out{down_subject(building, order.verb), reply, {}, {}};
  out.headers[header::kWho] = order.who;
  out.headers[header::kRequest] = order.request;
  out.headers[header::kUntil] = std::to_string(until_us / daemon::kSecond_us);
  if (order.verb == "acknowledge") {
    const json content = json::parse(order.content, nullptr, false);
    out.bytes = drivers::encoded(daemon::acknowledge_request(
        content.value("id", std::int64_t{0}), order.who, content.value("comment", "")));
  } else if (order.verb != "ping") {
    out.bytes.assign(order.content.begin(), order.content.end());
  }
  return out;
}

Commander::Commander(Link& link, std::function<void(const CommandResult&)> tell)
    : link_(link), tell_(std::move(tell)) {}

bool Commander::give(CommandOrder order) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (orders_.size() >= kMaxOrders) return false;
  orders_.push_back(std::move(order));
  return true;
}

void Commander::step(std::int64_t steady_us, std::int64_t utc_us) {
  for (const Message& message : link_.take()) take(message);
  std::deque<CommandOrder> orders;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    orders.swap(orders_);
  }
  for (const CommandOrder& order : orders) send(order, steady_us, utc_us);
  for (auto at = waiting_.begin(); at != waiting_.end();) {
    if (steady_us < at->second.until_us) {
      ++at;
      continue;
    }
    tell_({at->second.request, at->second.building, false, "no answer in time"});
    at = waiting_.erase(at);
  }
}

void Commander::send(const CommandOrder& order, std::int64_t steady_us, std::int64_t utc_us) {
  for (const CommandOrder::Target& target : order.targets) {
    const std::string reply = fmt::format("{}.{}", link_.inbox(), ++number_);
    if (!link_.publish(command_message(order, target.name, reply, utc_us + kVoid_us)))
      tell_({order.request, target.id, false, "the hub is not connected"});
    else
      waiting_[reply] = {order.request, target.id, steady_us + kWait_us};
  }
}

void Commander::take(const Message& message) {
  const auto found = waiting_.find(message.subject);
  if (found == waiting_.end()) return;
  const Waiting waiting = found->second;
  waiting_.erase(found);
  const std::string why = answer_of(message);
  tell_({waiting.request, waiting.building, why.empty(), why});
}

}  // namespace framewatch::fleet
