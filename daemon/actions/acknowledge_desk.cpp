#include "daemon/actions/acknowledge_desk.h"

#include <utility>

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/event_t.hpp>

#include <fmt/core.h>
#include <lcm/lcm-cpp.hpp>

#include "daemon/base/log.h"
#include "daemon/events/acknowledge_messages.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMostText = 500;  // bytes of who, and of the comment

}  // namespace

AcknowledgeDesk::AcknowledgeDesk(const Config& config, lcm::LCM& lcm)
    : config_(config),
      lcm_(lcm),
      subscription_(
          lcm.subscribe(config.lcm.prefix + "ACKNOWLEDGE", &AcknowledgeDesk::on_message, this)) {}

AcknowledgeDesk::~AcknowledgeDesk() {
  lcm_.unsubscribe(subscription_);
}

void AcknowledgeDesk::on_message(const lcm::ReceiveBuffer* buffer, const std::string&) {
  auto request = drivers::decoded<acknowledge_t>(
      {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
  if (!request || requests_.size() == kMostRequests) return;
  for (std::string* text : {&request->who, &request->comment})
    if (text->size() > kMostText) text->resize(kMostText);
  requests_.push_back(std::move(*request));
}

void AcknowledgeDesk::answer(const acknowledge_t& request, const std::vector<RaisedEvents*>& raised,
                             const Done& done) {
  const Acknowledgement by{request.time_us, request.who, request.comment};
  bool any = false;
  for (RaisedEvents* events : raised)
    for (const event_t& e : events->all()) {
      if (request.id != 0 && request.id != e.id) continue;
      any = true;
      if (request.id == 0 && events->acknowledgement(e.id) != nullptr) continue;
      events->acknowledge(e.id, by);
      log(LogLevel::notice, fmt::format("event {} ({} {}) is acknowledged by {}: {}", e.id, e.kind,
                                        e.place, by.who, by.comment));
      done(e, by);
    }
  answered_ = request.request;
  refused_ = any               ? ""
             : request.id == 0 ? "no event is raised"
                               : fmt::format("no event {} is raised", request.id);
}

void AcknowledgeDesk::look(const std::vector<RaisedEvents*>& raised, const Done& done,
                           std::int64_t now_us) {
  const std::vector<acknowledge_t> requests = std::exchange(requests_, {});
  for (const acknowledge_t& request : requests)
    if (request.request != answered_) answer(request, raised, done);
  const bool due = second_.due(now_us);
  if (requests.empty() && !due) return;
  acknowledged_t out{};
  out.time_us = now_us;
  out.answered = answered_;
  out.refused = refused_;
  for (const RaisedEvents* events : raised)
    for (const event_t& e : events->all())
      if (const Acknowledgement* by = events->acknowledgement(e.id)) add_acknowledged(out, e, *by);
  lcm_.publish(config_.lcm.prefix + "ACKNOWLEDGED", &out);
}

}  // namespace framewatch::daemon
