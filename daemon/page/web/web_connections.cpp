// SPDX-License-Identifier: MIT
#include "daemon/page/web/web_connections.h"

#include <algorithm>
#include <utility>

namespace framewatch::daemon {

using Endings = std::vector<WebConnections::Ending>;

WebConnections::Connection* WebConnections::find(int connection) {
  const auto number = numbers_.find(connection);
  return number == numbers_.end() ? nullptr : &connections_.at(number->second);
}

int& WebConnections::of(State state, Held& held) {
  return state == State::waiting     ? held.waiting
         : state == State::answering ? held.answering
         : state == State::watching  ? held.watching
                                     : held.ended;
}

void WebConnections::enter(Connection& c, State state) {
  Held& held = held_[c.from.text];
  for (Held* counts : {&held, &all_}) {
    --of(c.state, *counts);
    ++of(state, *counts);
  }
  if (!c.from.local)
    viewers_elsewhere_ += (state == State::watching) - (c.state == State::watching);
  c.state = state;
}

WebConnections::Ending WebConnections::end(Connection& c, Why why) {
  enter(c, State::ended);
  answer_bytes_ -= std::exchange(c.bytes, 0);
  ++(why == Why::late_request  ? ended_.late_requests
     : why == Why::late_answer ? ended_.late_answers
                               : ended_.crowded_out);
  return {c.connection, why, c.from.text};
}

/// Returns the oldest connection in `state` of the address that holds most of them beyond its
/// reserve. Prefers other machines among equals.
WebConnections::Connection* WebConnections::most_dispensable(State state, const Connection& keep) {
  const std::string* busiest = nullptr;
  int most = 0;
  for (auto& [address, held] : held_) {
    const bool has_kept = keep.state == state && address == keep.from.text;
    const int count = of(state, held) - (has_kept ? 1 : 0);
    const int beyond = count - (held.local ? limits_.kept_local : 0);
    if (count == 0 || (busiest && (held.local ? beyond <= most : beyond < most))) continue;
    busiest = &address;
    most = beyond;
  }
  if (busiest == nullptr) return nullptr;
  for (auto& [number, c] : connections_)
    if (c.state == state && &c != &keep && c.from.text == *busiest) return &c;
  return nullptr;
}

Endings WebConnections::crowded_out(State state, const Connection& keep) {
  Endings out;
  while (all_.waiting > limits_.waiting || all_.answering > limits_.answering ||
         answer_bytes_ > limits_.answer_bytes) {
    Connection* const gone = most_dispensable(state, keep);
    if (gone == nullptr) break;
    out.push_back(end(*gone, Why::crowded));
  }
  return out;
}

Endings WebConnections::opened(int connection, PeerAddress from, std::int64_t now_us) {
  closed(connection);
  const std::uint64_t number = next_++;
  numbers_[connection] = number;
  Held& held = held_[from.text];
  held.local = from.local;
  ++held.waiting;
  ++all_.waiting;
  const Connection& c =
      connections_.insert({number, {connection, std::move(from), State::waiting, now_us, 0}})
          .first->second;
  return crowded_out(State::waiting, c);
}

Endings WebConnections::asked(int connection, std::int64_t now_us) {
  Connection* const c = find(connection);
  if (c == nullptr || c->state != State::waiting) return {};
  enter(*c, State::answering);
  c->since_us = now_us;
  return crowded_out(State::answering, *c);
}

Endings WebConnections::answered(int connection, std::size_t bytes) {
  Connection* const c = find(connection);
  if (c == nullptr || c->state != State::answering) return {};
  c->bytes += bytes;
  answer_bytes_ += bytes;
  return crowded_out(State::answering, *c);
}

Endings WebConnections::overdue(std::int64_t now_us) {
  Endings out;
  for (auto& [number, c] : connections_)
    if (c.state == State::waiting && now_us - c.since_us >= limits_.request_us)
      out.push_back(end(c, Why::late_request));
    else if (c.state == State::answering && now_us - c.since_us >= limits_.answer_us)
      out.push_back(end(c, Why::late_answer));
  return out;
}

bool WebConnections::watches(int connection) {
  Connection* const c = find(connection);
  if (c == nullptr || c->state != State::answering) return false;
  const int most_elsewhere = limits_.viewers - std::min(limits_.kept_local, limits_.viewers / 4);
  if (all_.watching >= limits_.viewers ||
      held_[c->from.text].watching >= limits_.viewers_per_address ||
      (!c->from.local && viewers_elsewhere_ >= most_elsewhere)) {
    ++ended_.viewers_refused;
    return false;
  }
  enter(*c, State::watching);
  return true;
}

void WebConnections::closed(int connection) {
  const auto number = numbers_.find(connection);
  if (number == numbers_.end()) return;
  Connection& c = connections_.at(number->second);
  enter(c, State::ended);
  --all_.ended;
  Held& held = held_.at(c.from.text);
  --held.ended;
  if (held.waiting + held.answering + held.watching + held.ended == 0) held_.erase(c.from.text);
  answer_bytes_ -= c.bytes;
  connections_.erase(number->second);
  numbers_.erase(number);
}

PageUse WebConnections::use() const {
  PageUse out = ended_;
  out.waiting = all_.waiting;
  out.answering = all_.answering;
  out.viewers = all_.watching;
  return out;
}

}  // namespace framewatch::daemon
