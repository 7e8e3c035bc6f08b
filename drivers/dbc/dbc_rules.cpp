// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <fmt/core.h>

#include "drivers/can/can_frame.h"
#include "drivers/dbc/dbc.h"

namespace framewatch::drivers {
namespace {

/// Finds for each bit of a frame the first signal that uses it.
class BitOwners {
 public:
  static constexpr std::size_t kUnused = SIZE_MAX;

  void enter(const CanField& field, std::size_t signal) {
    for_each_bit(field, [&](int bit) {
      std::size_t& owner = owners_[static_cast<std::size_t>(bit)];
      owner = std::min(owner, signal);
    });
  }
  /// Returns the first signal that uses a bit of the field, or kUnused.
  std::size_t first_of(const CanField& field) const {
    std::size_t first = kUnused;
    for_each_bit(field,
                 [&](int bit) { first = std::min(first, owners_[static_cast<std::size_t>(bit)]); });
    return first;
  }

 private:
  std::vector<std::size_t> owners_ = std::vector<std::size_t>(512, kUnused);
};

/// Reports signals that share a bit and can be present at the same time, each with the first signal
/// before it that shares a bit.
void check_overlaps(const DbcMessage& message, std::vector<DbcRule>& rules) {
  std::map<std::int64_t, std::vector<std::size_t>> multiplexed;
  BitOwners anyones, always;
  for (std::size_t i = 0; i < message.signals.size(); ++i) {
    const DbcSignal& s = message.signals[i];
    if (!fits(s.field, message.length)) continue;
    anyones.enter(s.field, i);
    if (s.multiplexed_by)
      multiplexed[*s.multiplexed_by].push_back(i);
    else
      always.enter(s.field, i);
  }
  std::vector<std::size_t> shared_with(message.signals.size(), BitOwners::kUnused);
  for (std::size_t i = 0; i < message.signals.size(); ++i)
    if (const DbcSignal& s = message.signals[i]; fits(s.field, message.length))
      shared_with[i] = (s.multiplexed_by ? always : anyones).first_of(s.field);
  for (const auto& [value, signals] : multiplexed) {
    BitOwners here;
    for (const std::size_t i : signals) {
      const CanField& field = message.signals[i].field;
      shared_with[i] = std::min(shared_with[i], here.first_of(field));
      here.enter(field, i);
    }
  }
  for (std::size_t i = 0; i < message.signals.size(); ++i) {
    if (shared_with[i] >= i) continue;
    const DbcSignal &first = message.signals[shared_with[i]], &second = message.signals[i];
    rules.push_back({second.line, fmt::format("signal {} overlaps {} (line {})", second.name,
                                              first.name, first.line)});
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
    rules.push_back({multiplexor->line, "a multiplexor must be a whole number"});
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
