#include "fleet/uplink/send_window.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace framewatch::fleet {
namespace {

constexpr int kMaxDoublings = 5;

}  // namespace

bool SendWindow::silent(std::int64_t now_us) const {
  // What was refused was answered, and is not due.
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

}  // namespace framewatch::fleet
