#include "fleet/serve/command_order.h"

#include <algorithm>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <framewatch/acknowledge_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/monitor/events/event_messages.h"
#include "drivers/files/encoded.h"
#include "drivers/files/number_text.h"
#include "fleet/message/subject.h"

namespace framewatch::fleet {
namespace {

using nlohmann::json;

constexpr std::string_view kCommandVerbs[] = {"ping", "acknowledge", "minutes", "resend", "raw"};
constexpr std::size_t kLongestComment = 500, kLongestChannels = 20'000;

bool put_time(json& out, const CommandWords& words, std::string& why) {
  const auto from = drivers::parse_integer(words.from_us), to = drivers::parse_integer(words.to_us);
  if (!from || !to || *from >= *to) {
    why = "from_us and to_us must be whole numbers of us since 1970, the second above the first";
    return false;
  }
  out["from_us"] = *from;
  out["to_us"] = *to;
  return true;
}

}  // namespace

std::optional<std::string> command_content(const CommandWords& words, std::string& why) {
  json out = json::object();
  if (std::find(std::begin(kCommandVerbs), std::end(kCommandVerbs), words.verb) ==
      std::end(kCommandVerbs)) {
    why = "a verb is ping, acknowledge, minutes, resend or raw";
    return std::nullopt;
  }
  if (words.verb == "acknowledge") {
    const auto id = drivers::parse_integer(words.id);
    if (!id || *id == 0 || words.comment.size() > kLongestComment) {
      why = "id must be that of an event, and a comment has 500 bytes at most";
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

}  // namespace framewatch::fleet
