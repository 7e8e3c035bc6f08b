#include <bitset>
#include <cmath>
#include <map>

#include <fmt/core.h>

#include "drivers/can/can_frame.h"
#include "drivers/dbc/dbc.h"

namespace framewatch::drivers {
namespace {

using Bits = std::bitset<512>;

Bits bits_of(const CanField& field) {
  Bits bits;
  for_each_bit(field, [&](int bit) { bits.set(static_cast<std::size_t>(bit)); });
  return bits;
}

/// Signals that may be there at the same time must not share a bit.
void check_overlaps(const DbcMessage& message, std::vector<DbcRule>& rules) {
  std::vector<Bits> bits;
  for (const DbcSignal& s : message.signals)
    bits.push_back(fits(s.field, message.length) ? bits_of(s.field) : Bits{});
  for (std::size_t b = 1; b < message.signals.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      const DbcSignal &first = message.signals[a], &second = message.signals[b];
      const bool apart = first.multiplexed_by && second.multiplexed_by &&
                         *first.multiplexed_by != *second.multiplexed_by;
      if (apart || (bits[a] & bits[b]).none()) continue;
      rules.push_back({second.line, fmt::format("signal {} overlaps {} (line {})", second.name,
                                                first.name, first.line)});
      break;
    }
}

void check_multiplexing(const DbcMessage& message, std::vector<DbcRule>& rules) {
  const DbcSignal* multiplexor = nullptr;
  for (const DbcSignal& s : message.signals) {
    if (!s.is_multiplexor || s.multiplexed_by) continue;
    if (multiplexor != nullptr)
      rules.push_back({s.line, fmt::format("{} has two multiplexors, {} and {}", message.name,
                                           multiplexor->name, s.name)});
    multiplexor = &s;
  }
  if (multiplexor != nullptr && multiplexor->field.value != CanValue::integer)
    rules.push_back({multiplexor->line, "a multiplexor is a whole number"});
  for (const DbcSignal& s : message.signals) {
    if (!s.multiplexed_by) continue;
    if (multiplexor == nullptr)
      rules.push_back({s.line, fmt::format("signal {} is multiplexed and {} has no multiplexor",
                                           s.name, message.name)});
    else if (multiplexor->field.bits < 63 && (*s.multiplexed_by >> multiplexor->field.bits) != 0)
      rules.push_back(
          {s.line, fmt::format("multiplexor {} has {} bits and is never {}", multiplexor->name,
                               multiplexor->field.bits, *s.multiplexed_by)});
  }
}

void check_signal(const DbcMessage& message, const DbcSignal& s, std::vector<DbcRule>& rules) {
  if (!fits(s.field, message.length))
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
  std::vector<DbcRule> rules;
  if (!is_fd_length(message.length))
    rules.push_back(
        {message.line, fmt::format("{}: no CAN frame has {} bytes", message.name, message.length)});
  std::map<std::string, std::int64_t> lines;
  for (const DbcSignal& s : message.signals) {
    const auto [at, fresh] = lines.emplace(s.name, s.line);
    if (!fresh)
      rules.push_back({s.line, fmt::format("{} has signal {} already (line {})", message.name,
                                           s.name, at->second)});
    check_signal(message, s, rules);
  }
  check_multiplexing(message, rules);
  check_overlaps(message, rules);
  return rules;
}

}  // namespace framewatch::drivers
