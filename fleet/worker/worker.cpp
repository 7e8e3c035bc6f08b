// SPDX-License-Identifier: MIT
#include "fleet/worker/worker.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "fleet/message/address.h"
#include "fleet/worker/automation.h"
#include "fleet/worker/judge.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kNext = "$JS.API.CONSUMER.MSG.NEXT.";
constexpr std::size_t kAskedAtOnce = 250;
constexpr std::int64_t kCommandHolds_s = 60;
constexpr std::int64_t kGrace_us = 1'000'000;  // after the hub should have ended a request

}  // namespace

bool FloodGate::takes(const std::string& building, std::size_t bytes, std::int64_t hub_us) {
  const std::int64_t hour_us = hub_us - hub_us % (3600 * daemon::kSecond_us);
  if (hour_us != hour_us_) {
    floods_ = take_floods();
    said_.clear();
    hour_us_ = hour_us;
  }
  Said& said = said_[building];
  const auto size = static_cast<std::int64_t>(bytes);
  if (said.messages < most_messages_ && said.bytes + size <= most_bytes_) {
    ++said.messages;
    said.bytes += size;
    return true;
  }
  ++said.flood_messages;
  said.flood_bytes += size;
  return false;
}

std::vector<ReceivedFlood> FloodGate::take_floods() {
  std::vector<ReceivedFlood> out = std::exchange(floods_, {});
  for (auto& [building, said] : said_) {
    if (said.flood_messages == 0) continue;
    out.push_back({building, hour_us_, std::exchange(said.flood_messages, 0),
                   std::exchange(said.flood_bytes, 0)});
  }
  return out;
}

Worker::Worker(Link& link, StoreSink store, MissingDays missing, FloodGate gate)
    : link_(link),
      store_(std::move(store)),
      missing_(std::move(missing)),
      gate_(std::move(gate)),
      consumers_{{"FW_EVENT", "store"},
                 {"FW_SUMMARY", "store"},
                 {"FW_LAST", "page"},
                 {"FW_RAW", "store"}} {
  for (Consumer& consumer : consumers_)
    consumer.inbox = fmt::format("{}.{}", link_.inbox(), consumer.stream);
}

void Worker::step(const WorkerTime& now) {
  if (std::exchange(connections_, link_.connections()) != link_.connections())
    for (Consumer& consumer : consumers_) consumer.asked_us = 0;  // requests are lost
  for (Message& message : link_.take()) take(std::move(message), now);
  const bool due = !waiting_.empty() &&
                   (waiting_.size() >= kMaxMessages || now.steady_us - since_us_ >= kLongest_us);
  if (due) store(now);
  if (now.steady_us < pause_until_us_) return;
  compare_inventories(now);
  for (Consumer& consumer : consumers_) {
    const bool old = now.steady_us - consumer.asked_us > kPull_us + kGrace_us;
    if (consumer.asked_us == 0 || consumer.lacking == 0 || old) ask(consumer, now.steady_us);
  }
}

void Worker::ask(Consumer& consumer, std::int64_t steady_us) {
  if (waiting_.size() + kAskedAtOnce > 2 * kMaxMessages) return;
  const std::string request =
      fmt::format("{{\"batch\":{},\"expires\":{}}}", kAskedAtOnce, kPull_us * 1000);
  const std::string subject = fmt::format("{}{}.{}", kNext, consumer.stream, consumer.name);
  if (!link_.publish({subject, consumer.inbox, {}, Bytes(request.begin(), request.end())})) return;
  consumer.asked_us = steady_us;
  consumer.lacking = kAskedAtOnce;
}

/// Handles a status message of the hub, which ends a request: 404 no messages, 408 timeout, 409 the
/// consumer or the leader changed, 503 no receiver. Waits a while after the last three.
void Worker::take(Message message, const WorkerTime& now) {
  if (!message.header(header::kStatus).empty()) {
    for (Consumer& consumer : consumers_)
      if (message.subject == consumer.inbox)
        consumer.lacking = message.header(header::kStatus) == "408" ? 0 : consumer.lacking;
    return;
  }
  if (message.reply.empty()) return;  // cannot be acknowledged
  for (Consumer& consumer : consumers_)
    if (message.reply.find(fmt::format(".{}.", consumer.stream)) != std::string::npos &&
        consumer.lacking > 0)
      --consumer.lacking;
  if (waiting_.empty()) since_us_ = now.steady_us;
  waiting_.push_back(std::move(message));
}

/// Moves messages over the limit to the end. Returns the number of messages before them.
std::size_t Worker::put_floods_last(const WorkerTime& now) {
  const auto within = [&](const Message& message) {
    const auto parts = up_parts(message.subject);
    return !parts || gate_.takes(parts->building, message.size(), now.hub_us);
  };
  return static_cast<std::size_t>(std::distance(
      waiting_.begin(), std::stable_partition(waiting_.begin(), waiting_.end(), within)));
}

void Worker::count(const FleetBatch& batch, std::size_t messages) {
  counters_.stored += static_cast<std::int64_t>(messages);
  for (const ReceivedOther& other : batch.others)
    ++(other.reason.empty() ? counters_.unknown : counters_.refused);
  for (const ReceivedFlood& flood : batch.floods) counters_.flooding += flood.messages;
  ++counters_.batches;
  // Building automation does not acknowledge; the next heartbeat repeats the state.
  for (const Message& message : automation_messages(batch)) (void)link_.publish(message);
}

void Worker::acknowledge(const Message& message) {
  (void)link_.publish({message.reply, "", {}, {}});  // if this is lost, the message comes again
}

/// Asks the hub to deliver the message again, to any worker, after the pause.
void Worker::give_back(const Message& message) {
  const std::string text = fmt::format("-NAK {{\"delay\":{}}}", pause_us_ * 1000);
  (void)link_.publish({message.reply, "", {}, Bytes(text.begin(), text.end())});
}

void Worker::store(const WorkerTime& now) {
  FloodGate before = gate_;
  const std::size_t within = put_floods_last(now);
  FleetBatch batch;
  for (std::size_t i = 0; i < within; ++i) judge(waiting_[i], now.hub_us, batch);
  batch.floods = gate_.take_floods();
  const StoreOutcome outcome = store_(batch);
  counters_.trouble = outcome.problem;
  if (outcome.problem.empty()) {
    for (const Message& message : waiting_) acknowledge(message);
    count(batch, waiting_.size());
    note_inventories(batch, now.steady_us);
    pause_us_ = 0;
  } else if (outcome.lasting) {
    store_one_by_one(within, std::move(batch.floods), now);
  } else {
    // Nothing is acknowledged or published, because the hub delivers all of it again.
    gate_ = std::move(before);
    pause_us_ = std::clamp(2 * pause_us_, kShortestPause_us, kLongestPause_us);
    pause_until_us_ = now.steady_us + pause_us_;
    for (const Message& message : waiting_) give_back(message);
  }
  waiting_.clear();
}

/// Stores messages singly, so that one that the database rejects does not stop the others.
void Worker::store_one_by_one(std::size_t within, std::vector<ReceivedFlood> floods,
                              const WorkerTime& now) {
  for (std::size_t i = 0; i < within; ++i) {
    const Message& message = waiting_[i];
    FleetBatch batch;
    judge(message, now.hub_us, batch);
    StoreOutcome outcome = store_(batch);
    if (outcome.lasting) {
      batch = {};
      batch.others.push_back({message.subject, message.header(header::kKey),
                              "the database rejects it: " + outcome.problem,
                              message.header(header::kType), message.header(header::kVersion),
                              message.bytes});
      outcome = store_(batch);
    }
    counters_.trouble = outcome.problem;
    if (!outcome.problem.empty()) return;
    acknowledge(message);
    count(batch, 1);
  }
  FleetBatch rest;
  rest.floods = std::move(floods);
  counters_.trouble = store_(rest).problem;
  if (!counters_.trouble.empty()) return;
  for (std::size_t i = within; i < waiting_.size(); ++i) acknowledge(waiting_[i]);
  count(rest, waiting_.size() - within);
}

void Worker::note_inventories(const FleetBatch& batch, std::int64_t steady_us) {
  if (!missing_) return;
  for (const ReceivedNewest& newest : batch.newest)
    if (newest.kind == "inventory" && to_compare_.size() < kMaxCompared)
      to_compare_.insert({newest.building, steady_us + kBeforeCompared_us});
}

/// Compares one inventory between batches. If the database fails, waits for tomorrow's inventory.
void Worker::compare_inventories(const WorkerTime& now) {
  const auto due = std::find_if(to_compare_.begin(), to_compare_.end(),
                                [&](const auto& one) { return one.second <= now.steady_us; });
  if (due == to_compare_.end()) return;
  const std::string building = due->first;
  to_compare_.erase(due);
  const auto days = missing_(building);
  for (std::size_t i = 0; days && i < std::min(days->size(), kMaxResent_days); ++i)
    ask_again(building, (*days)[i], now);
}

void Worker::ask_again(const std::string& building, std::int64_t from_us, const WorkerTime& now) {
  const std::string text =
      fmt::format("{{\"from_us\":{},\"to_us\":{}}}", from_us, from_us + daemon::kDay_us);
  const std::int64_t now_s = now.hub_us / daemon::kSecond_us;
  Message request{down_subject(building, "resend"), "", {}, Bytes(text.begin(), text.end())};
  request.headers = {
      {header::kWho, "worker"},
      {header::kRequest, fmt::format("inventory-{}-{}", from_us / daemon::kDay_us, now_s)},
      {header::kUntil, fmt::format("{}", now_s + kCommandHolds_s)}};
  if (link_.publish(request)) ++counters_.resends;
}

void Worker::finish(const WorkerTime& now) {
  if (!waiting_.empty()) store(now);
}

}  // namespace framewatch::fleet
