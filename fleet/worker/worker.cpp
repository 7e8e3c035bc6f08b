#include "fleet/worker/worker.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "fleet/message/subject.h"
#include "fleet/worker/automation.h"
#include "fleet/worker/judge.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kNext = "$JS.API.CONSUMER.MSG.NEXT.";
constexpr std::size_t kAskedAtOnce = 250;
constexpr std::int64_t kGrace_us = 1'000'000;  // after the hub's own end of a request

}  // namespace

Worker::Worker(Link& link, StoreSink store, FloodGate gate)
    : link_(link),
      store_(std::move(store)),
      gate_(std::move(gate)),
      consumers_{{"FW_EVENT", "store"},
                 {"FW_SUMMARY", "store"},
                 {"FW_LAST", "page"},
                 {"FW_RAW", "store"}} {
  for (Consumer& consumer : consumers_)
    consumer.inbox = fmt::format("{}.{}", link_.inbox(), consumer.stream);
  link_.listen(link_.inbox() + ".*");
}

void Worker::step(const WorkerTime& now) {
  if (std::exchange(connections_, link_.connections()) != link_.connections())
    for (Consumer& consumer : consumers_) consumer.asked_us = 0;  // requests went with the line
  for (Message& message : link_.take()) take(std::move(message), now);
  const bool due = !waiting_.empty() &&
                   (waiting_.size() >= kMostMessages || now.steady_us - since_us_ >= kLongest_us);
  if (due) store(now);
  if (now.steady_us < pause_until_us_) return;
  for (Consumer& consumer : consumers_) {
    const bool old = now.steady_us - consumer.asked_us > kPull_us + kGrace_us;
    if (consumer.asked_us == 0 || consumer.lacking == 0 || old) ask(consumer, now.steady_us);
  }
}

void Worker::ask(Consumer& consumer, std::int64_t steady_us) {
  if (waiting_.size() + kAskedAtOnce > 2 * kMostMessages) return;
  const std::string request =
      fmt::format("{{\"batch\":{},\"expires\":{}}}", kAskedAtOnce, kPull_us * 1000);
  const std::string subject = fmt::format("{}{}.{}", kNext, consumer.stream, consumer.name);
  if (!link_.publish({subject, consumer.inbox, {}, Bytes(request.begin(), request.end())})) return;
  consumer.asked_us = steady_us;
  consumer.lacking = kAskedAtOnce;
}

/// A message of the hub itself ends a request: 404 nothing there, 408 its time is over, 409 the
/// consumer or the leader changed, 503 nobody is there. What the last three say holds for a while.
void Worker::take(Message message, const WorkerTime& now) {
  if (!message.header(header::kStatus).empty()) {
    for (Consumer& consumer : consumers_)
      if (message.subject == consumer.inbox)
        consumer.lacking = message.header(header::kStatus) == "408" ? 0 : consumer.lacking;
    return;
  }
  if (message.reply.empty()) return;  // nothing that could be acknowledged
  for (Consumer& consumer : consumers_)
    if (message.reply.find(fmt::format(".{}.", consumer.stream)) != std::string::npos &&
        consumer.lacking > 0)
      --consumer.lacking;
  if (waiting_.empty()) since_us_ = now.steady_us;
  waiting_.push_back(std::move(message));
}

FleetBatch Worker::batch_of(const Message* begin, const Message* end, const WorkerTime& now) {
  FleetBatch batch;
  for (const Message* message = begin; message != end; ++message) {
    const auto parts = up_parts(message->subject);
    if (!parts || gate_.takes(parts->building, message->size(), now.hub_us))
      judge(*message, now.hub_us, batch);
  }
  return batch;
}

void Worker::count(const FleetBatch& batch, std::size_t messages) {
  counters_.stored += static_cast<std::int64_t>(messages);
  for (const ReceivedOther& other : batch.others)
    ++(other.reason.empty() ? counters_.unknown : counters_.refused);
  for (const ReceivedFlood& flood : batch.floods) counters_.flooding += flood.messages;
  ++counters_.batches;
  // What is stored is told to building automation, which acknowledges nothing: the next heartbeat
  // says it again.
  for (const Message& message : automation_messages(batch)) (void)link_.publish(message);
}

void Worker::acknowledge(const Message& message) {
  (void)link_.publish({message.reply, "", {}, {}});  // if it is lost, the message comes again
}

void Worker::store(const WorkerTime& now) {
  FloodGate before = gate_;
  FleetBatch batch = batch_of(waiting_.data(), waiting_.data() + waiting_.size(), now);
  batch.floods = gate_.take_floods();
  const StoreOutcome outcome = store_(batch);
  counters_.trouble = outcome.problem;
  if (outcome.problem.empty()) {
    for (const Message& message : waiting_) acknowledge(message);
    count(batch, waiting_.size());
    pause_us_ = 0;
  } else if (outcome.lasting) {
    store_one_by_one(now);
  } else {
    // Nothing is acknowledged: the hub keeps it, and gives it again. So nothing of it was said yet.
    gate_ = std::move(before);
    pause_us_ = std::clamp(2 * pause_us_, kShortestPause_us, kLongestPause_us);
    pause_until_us_ = now.steady_us + pause_us_;
  }
  waiting_.clear();
}

/// One message that the database cannot take does not stop the others.
void Worker::store_one_by_one(const WorkerTime& now) {
  for (const Message& message : waiting_) {
    FleetBatch batch;
    judge(message, now.hub_us, batch);
    StoreOutcome outcome = store_(batch);
    if (outcome.lasting) {
      batch = {};
      batch.others.push_back({message.subject, message.header(header::kKey),
                              "the database does not take it: " + outcome.problem,
                              message.header(header::kType), message.header(header::kVersion),
                              message.bytes});
      outcome = store_(batch);
    }
    counters_.trouble = outcome.problem;
    if (!outcome.problem.empty()) return;
    acknowledge(message);
    count(batch, 1);
  }
}

void Worker::finish(const WorkerTime& now) {
  if (!waiting_.empty()) store(now);
}

}  // namespace framewatch::fleet
