// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "drivers/can/can_frame.h"
#include "drivers/dbc/dbc.h"

namespace framewatch::drivers {
namespace {

constexpr std::size_t kMostMultiplexors = 16;  ///< that switch one another
/// Signals and ranges of their multiplexors that are compared with each other.
constexpr std::size_t kMostCompared = 10'000;

/// A signal, the multiplexor that switches it, the one that switches that, and so on.
using Chain = std::vector<const DbcSignal*>;

/// Follows the multiplexors of a signal, one more than broken_rules() accepts. `find` returns the
/// signal of a name, or null.
template <typename Find>
Chain chain_of(const DbcSignal& signal, const Find& find) {
  Chain chain{&signal};
  while (!chain.back()->multiplexor.empty() && chain.size() <= kMostMultiplexors + 1) {
    const DbcSignal* next = find(chain.back()->multiplexor);
    if (next == nullptr || !next->is_multiplexor) break;
    chain.push_back(next);
  }
  return chain;
}

bool disjoint(const std::vector<ValueRange>& a, const std::vector<ValueRange>& b) {
  return std::all_of(a.begin(), a.end(), [&](const ValueRange& x) {
    return std::all_of(b.begin(), b.end(),
                       [&](const ValueRange& y) { return x.most < y.least || y.most < x.least; });
  });
}

/// Returns true if a multiplexor of both signals never switches on both.
bool exclude(const Chain& a, const Chain& b) {
  for (std::size_t i = 1; i < a.size(); ++i)
    for (std::size_t k = 1; k < b.size(); ++k)
      if (a[i] == b[k] && disjoint(a[i - 1]->present_at, b[k - 1]->present_at)) return true;
  return false;
}

/// Reports signals that share a bit and can be present at the same time, each with the first signal
/// before it that shares a bit.
void check_overlaps(const DbcMessage& message, const std::vector<Chain>& chains,
                    std::vector<DbcRule>& rules) {
  std::vector<std::bitset<512>> bits(message.signals.size());
  for (std::size_t i = 0; i < message.signals.size(); ++i) {
    const DbcSignal& s = message.signals[i];
    if (fits(s.field, std::min(message.length, 64)))
      for_each_bit(s.field, [&](int bit) { bits[i].set(static_cast<std::size_t>(bit)); });
    for (std::size_t k = 0; k < i; ++k) {
      if ((bits[i] & bits[k]).none() || exclude(chains[i], chains[k])) continue;
      const DbcSignal& first = message.signals[k];
      rules.push_back(
          {s.line, fmt::format("signal {} overlaps {} (line {})", s.name, first.name, first.line)});
      break;
    }
  }
}

void check_multiplexing(const DbcMessage& message, std::vector<DbcRule>& rules) {
  std::map<std::string, const DbcSignal*> names;
  for (const DbcSignal& s : message.signals) names.emplace(s.name, &s);
  const auto find = [&](const std::string& name) {
    const auto at = names.find(name);
    return at == names.end() ? nullptr : at->second;
  };
  std::vector<Chain> chains;
  std::size_t compared = 0;
  for (const DbcSignal& s : message.signals) {
    const Chain& chain = chains.emplace_back(chain_of(s, find));
    for (const DbcSignal* link : chain) compared += 1 + link->present_at.size();
    if (s.multiplexor.empty()) continue;
    if (chain.size() > kMostMultiplexors + 1)
      rules.push_back({s.line, fmt::format("signal {}: more than {} multiplexors switch one "
                                           "another, or they do so in a circle",
                                           s.name, kMostMultiplexors)});
    if (chain.size() < 2) {
      rules.push_back({s.line, fmt::format("signal {}: {} has no multiplexor {}", s.name,
                                           message.name, s.multiplexor)});
      continue;
    }
    const CanField& multiplexor = chain[1]->field;
    if (multiplexor.value != CanValue::integer)
      rules.push_back(
          {chain[1]->line, fmt::format("multiplexor {} must be a whole number", chain[1]->name)});
    for (const ValueRange& range : s.present_at)
      if (multiplexor.bits < 64 && (range.least >> multiplexor.bits) != 0)
        rules.push_back({s.line, fmt::format("multiplexor {} has {} bits and is never {}",
                                             chain[1]->name, multiplexor.bits, range.least)});
  }
  if (compared > kMostCompared)
    rules.push_back(
        {message.line, fmt::format("{} has too many signals: at most {} signals and values of "
                                   "multiplexors are compared with each other, it has {}",
                                   message.name, kMostCompared, compared)});
  else
    check_overlaps(message, chains, rules);
}

void check_signal(const DbcMessage& message, const DbcSignal& s, std::vector<DbcRule>& rules) {
  if (message.length <= 64 && !fits(s.field, message.length))
    rules.push_back({s.line, fmt::format("signal {}: {} bits from bit {} do not fit in {} bytes",
                                         s.name, s.field.bits, s.field.start, message.length)});
  if (!std::isfinite(s.field.factor) || s.field.factor == 0 || !std::isfinite(s.field.offset))
    rules.push_back(
        {s.line, fmt::format("signal {}: the factor must be finite and not 0", s.name)});
  const int needed = s.field.value == CanValue::float32   ? 32
                     : s.field.value == CanValue::float64 ? 64
                                                          : s.field.bits;
  if (s.field.bits != needed)
    rules.push_back({s.line, fmt::format("signal {} is floating and has {} bits, not {}", s.name,
                                         s.field.bits, needed)});
}

}  // namespace

std::vector<DbcRule> broken_rules(const DbcMessage& message) {
  std::vector<DbcRule> rules = message.contradictions;
  if (!is_fd_length(message.length))
    rules.push_back({message.line, fmt::format("{}: no CAN frame has {}{} bytes", message.name,
                                               message.length > 64 ? "more than " : "",
                                               std::min(message.length, 64))});
  std::map<std::string, std::int64_t> lines;
  for (const DbcSignal& s : message.signals) {
    const auto [at, fresh] = lines.emplace(s.name, s.line);
    if (!fresh)
      rules.push_back({s.line, fmt::format("{} has signal {} already (line {})", message.name,
                                           s.name, at->second)});
    check_signal(message, s, rules);
  }
  check_multiplexing(message, rules);
  return rules;
}

std::vector<CanSwitch> switches_of(const DbcMessage& message, const DbcSignal& signal) {
  const Chain chain = chain_of(signal, [&](const std::string& name) { return message.find(name); });
  std::vector<CanSwitch> out;
  for (std::size_t i = 1; i < chain.size(); ++i)
    out.push_back({chain[i]->field, chain[i - 1]->present_at});
  return out;
}

}  // namespace framewatch::drivers
