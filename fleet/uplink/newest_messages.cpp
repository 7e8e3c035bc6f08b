#include "fleet/uplink/newest_messages.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/history_status_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/watch_t.hpp>

#include "drivers/lcm/message_check.h"

namespace framewatch::fleet {
namespace {

struct Kind {
  const char *channel, *kind, *type;
  std::int64_t (*fingerprint)();
};

const Kind kKinds[] = {
    {"SERVICE", "service", "service_t", [] { return service_t::getHash(); }},
    {"STATUS", "status", "status_t", [] { return status_t::getHash(); }},
    {"HISTORY", "history", "history_status_t", [] { return history_status_t::getHash(); }},
    {"WATCH", "watch", "watch_t", [] { return watch_t::getHash(); }},
    {"ACKNOWLEDGED", "acknowledged", "acknowledged_t", [] { return acknowledged_t::getHash(); }},
    {"PARAMETERS", "parameters", "parameter_table_t", [] { return parameter_table_t::getHash(); }},
};

constexpr const char *kService = "service", *kAcknowledged = "acknowledged";

std::int64_t interval_us(const std::string& kind) {
  if (kind == kService) return NewestMessages::kService_us;
  const auto is_it = [&](const Kind& k) { return kind == k.kind; };
  const bool heard = std::any_of(std::begin(kKinds), std::end(kKinds), is_it);
  return heard ? NewestMessages::kOther_us : NewestMessages::kText_us;
}

}  // namespace

const std::vector<std::string>& NewestMessages::channels() {
  static const std::vector<std::string> kChannels = [] {
    std::vector<std::string> out;
    for (const Kind& kind : kKinds) out.emplace_back(kind.channel);
    return out;
  }();
  return kChannels;
}

void NewestMessages::heard(std::string_view channel, std::span<const std::uint8_t> bytes) {
  for (const Kind& kind : kKinds) {
    if (channel != kind.channel || !drivers::is_well_formed(bytes, kind.fingerprint())) continue;
    if (channel == "SERVICE") take_service(bytes);
    if (channel == "ACKNOWLEDGED") take_acknowledged(bytes);
    if (channel == "PARAMETERS")
      if (auto table = drivers::decoded<parameter_table_t>(bytes)) {
        config_is(table->config_sha256);
        table_ = std::move(table);
      }
    Newest& newest = newest_[kind.kind];
    newest.type = kind.type;
    newest.content.assign(bytes.begin(), bytes.end());
  }
}

void NewestMessages::take_service(std::span<const std::uint8_t> bytes) {
  const auto service = drivers::decoded<service_t>(bytes);
  if (!service) return;
  config_is(service->config_sha256);
  if (std::exchange(raised_, service->event_id) != service->event_id)
    newest_[kService].given_us.reset();
}

void NewestMessages::take_acknowledged(std::span<const std::uint8_t> bytes) {
  const auto message = drivers::decoded<acknowledged_t>(bytes);
  if (message && std::exchange(acknowledged_, message->id) != message->id)
    newest_[kAcknowledged].given_us.reset();
}

void NewestMessages::config_is(const std::string& sha256) {
  if (std::exchange(config_sha256_, sha256) != sha256) again();
}

void NewestMessages::text(const std::string& kind, const std::string& type,
                          const std::string& content) {
  newest_[kind] = {type, {content.begin(), content.end()}, {}};
}

void NewestMessages::again() {
  for (auto& [kind, newest] : newest_) newest.given_us.reset();
}

std::optional<NewestMessages::Due> NewestMessages::due(std::int64_t now_us) {
  for (auto& [kind, newest] : newest_) {
    if (newest.content.empty()) continue;
    if (newest.given_us && now_us - *newest.given_us < interval_us(kind)) continue;
    newest.given_us = now_us;
    return Due{kind, newest.type, newest.content};
  }
  return std::nullopt;
}

}  // namespace framewatch::fleet
