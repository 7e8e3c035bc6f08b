#include "fleet/serve/commander.h"

#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/printable.h"

namespace framewatch::fleet {
namespace {

constexpr std::size_t kLongestAnswer = 500, kMaxBytes = 65'536;
constexpr const char* kNobody = "503";

/// Empty: done; else why not.
std::string answer_of(const Message& message) {
  if (message.header(header::kStatus) == kNobody) return "the building is away";
  if (message.bytes.size() > kMaxBytes) return "its answer is too long";
  const auto document =
      nlohmann::json::parse(message.bytes.begin(), message.bytes.end(), nullptr, false);
  if (!document.is_object() || !document.contains("ok") || !document["ok"].is_boolean())
    return "its answer cannot be read";
  if (document["ok"].get<bool>()) return {};
  const auto why = document.find("why");
  const std::string text = why != document.end() && why->is_string() ? why->get<std::string>() : "";
  return text.empty() ? "refused" : daemon::printable(text.substr(0, kLongestAnswer));
}

}  // namespace

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
      tell_({order.request, target.id, false, "the hub is away"});
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
