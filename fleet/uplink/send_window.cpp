// SPDX-License-Identifier: MIT
#include "fleet/uplink/send_window.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <utility>

#include <nlohmann/json.hpp>

namespace framewatch::fleet {
namespace {

constexpr int kMaxDoublings = 5;

using nlohmann::json;

// JetStream also answers 503 when a stream (10077) or the account (10023) is full; err_code has the
// difference.
constexpr std::array<std::int64_t, 2> kFull{10077, 10023};

std::int64_t number_of(const json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_number_integer() ? found->get<std::int64_t>() : 0;
}

Verdict refusal_of(const json& error) {
  Verdict out{Verdict::kUnavailable, "refused"};
  const std::int64_t code = number_of(error, "code"), own = number_of(error, "err_code");
  const bool full = std::find(kFull.begin(), kFull.end(), own) != kFull.end();
  if (full)
    out.code = static_cast<int>(own);
  else if (code > 0 && code < INT32_MAX)
    out.code = static_cast<int>(code);
  if (const auto why = error.find("description"); why != error.end() && why->is_string())
    out.why = why->get<std::string>();
  return out;
}

}  // namespace

bool SendWindow::silent(std::int64_t now_us) const {
  // Refused messages were answered and are not due yet.
  return open_.size() > refused_ && now_us - heard_us_ > kSilent_us;
}

bool SendWindow::takes(std::int64_t now_us) const {
  return open_.size() < kMaxMessages && bytes_ < kMaxBytes && !silent(now_us);
}

void SendWindow::add(Outgoing outgoing, std::int64_t now_us) {
  if (open_.size() == refused_) heard_us_ = std::max(heard_us_, now_us);
  bytes_ += outgoing.message.size();
  pieces_ += outgoing.request.empty() ? 0 : 1;
  summaries_ += outgoing.summary ? 1 : 0;
  if (const std::string key = outgoing.message.header(header::kKey); !key.empty())
    keys_.insert(key);
  open_[next_++] = {std::move(outgoing), now_us};
}

std::vector<std::int64_t> SendWindow::due(std::int64_t now_us) {
  std::vector<std::int64_t> out;
  const bool quiet = silent(now_us);
  for (auto& [number, open] : open_) {
    if (open.due_us <= now_us) {
      out.push_back(number);
      sent_again_ += open.sent > 0 ? 1 : 0;
      const std::int64_t again_us = kAgain_us << std::min(open.sent++, kMaxDoublings);
      open.due_us = now_us + (quiet ? kOldest_us : std::min(again_us, kSeldom_us));
    }
    if (quiet && !open.refused) break;
  }
  return out;
}

void SendWindow::not_taken(std::int64_t number, std::int64_t now_us) {
  if (const auto found = open_.find(number); found != open_.end()) found->second.due_us = now_us;
}

std::optional<Outgoing> SendWindow::acknowledged(std::int64_t number, std::int64_t now_us) {
  const auto found = open_.find(number);
  const bool was_silent = silent(now_us);
  heard_us_ = now_us;
  if (was_silent)
    for (auto& [other, open] : open_)
      if (!open.refused) {
        open.due_us = std::min(open.due_us, now_us);
        open.sent = std::min(open.sent, 1);
      }
  if (found == open_.end()) return std::nullopt;
  return taken(found);
}

Outgoing SendWindow::taken(std::map<std::int64_t, Open>::iterator at) {
  Outgoing out = std::move(at->second.outgoing);
  refused_ -= at->second.refused ? 1 : 0;
  open_.erase(at);
  keys_.erase(out.message.header(header::kKey));
  bytes_ -= out.message.size();
  pieces_ -= out.request.empty() ? 0 : 1;
  summaries_ -= out.summary ? 1 : 0;
  return out;
}

bool SendWindow::refused(std::int64_t number, std::int64_t now_us, std::int64_t wait_us) {
  const auto found = open_.find(number);
  if (found == open_.end()) return false;
  found->second.due_us = now_us + wait_us;
  refused_ += found->second.refused ? 0 : 1;
  found->second.refused = true;
  heard_us_ = std::max(heard_us_, now_us);
  return true;
}

void SendWindow::drop(const std::string& subject) {
  for (auto at = open_.begin(); at != open_.end();) {
    const auto next = std::next(at);
    if (at->second.outgoing.message.subject == subject) (void)taken(at);
    at = next;
  }
}

void SendWindow::reconnected(std::int64_t now_us) {
  for (auto& [number, open] : open_) open.due_us = std::min(open.due_us, now_us);
}

Verdict verdict_of(const Message& answer) {
  if (answer.header(header::kStatus) == "503")
    return {Verdict::kUnavailable, "no stream takes the message"};
  const json document = json::parse(answer.bytes.begin(), answer.bytes.end(), nullptr, false);
  if (!document.is_object()) return {};
  const auto error = document.find("error");
  if (error != document.end() && error->is_object()) return refusal_of(*error);
  if (!document.contains("seq")) return {};
  const auto duplicate = document.find("duplicate");
  return {0, "", duplicate != document.end() && *duplicate == true};
}

}  // namespace framewatch::fleet
