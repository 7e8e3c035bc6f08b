#include "daemon/monitor/estimation/intake_events.h"

#include <algorithm>
#include <string>

#include <fmt/core.h>

#include "daemon/monitor/events/event_words.h"

namespace framewatch::daemon {
namespace {

using drivers::IntakeNotice;
using drivers::SequenceTrouble;

constexpr std::int64_t kFirstIntakeId = std::int64_t{1} << 41;
constexpr std::size_t kLongestName = 64;

std::size_t kind_of(const IntakeNotice& n) {
  return n.of_table ? drivers::kSequenceTroubles : static_cast<std::size_t>(n.trouble);
}

/// The text is the sender's: nothing of it but plain characters.
std::string plain(const std::string& name) {
  std::string out = name.substr(0, kLongestName);
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return out;
}

std::string address(const std::string& stream, std::int32_t node, int axis) {
  return fmt::format("node {} {} of {}", node, axis >= 0 && axis <= 2 ? "xyz"[axis] : '?', stream);
}

std::string table_message(const IntakeNotice& n, const Config& config) {
  const std::string& name = config.pipeline.axes[n.axis].name;
  const std::string told = address(n.stream, n.told.node, n.told.axis);
  if (n.over) return fmt::format("no channel table contradicts {} any more", name);
  const AxisSource& source = config.sources[n.axis];
  const std::string what =
      n.told.name == name
          ? fmt::format("a channel table says that {} is {}", name, told)
          : fmt::format("a channel table calls {} \"{}\"", told, plain(n.told.name));
  return source.sensor_node >= 0
             ? fmt::format("{}, the configuration says that {} is {}: the configuration holds",
                           what, name, address(source.lcm_channel, source.sensor_node, source.axis))
             : fmt::format(
                   "{}, an earlier one bound {} otherwise, whose samples still come: the "
                   "earlier one holds",
                   what, name);
}

std::string two_senders_message(const IntakeNotice& n, const Config& config) {
  const std::string node = fmt::format("node {} of {}", n.node, n.stream);
  if (n.over) return fmt::format("{} has one sender again", node);
  const bool none = config.lcm.two_senders == drivers::TwoSenders::none;
  if (n.other == drivers::LcmSender{})
    return fmt::format("two send under {}: {}", node,
                       none ? "no sample of it is used"
                            : "the samples of the first are used where they can be told apart, "
                              "else none");
  return fmt::format("{} send under {}: {}",
                     drivers::to_text(n.bound) + " and " + drivers::to_text(n.other), node,
                     none ? "no sample of it is used" : "only the samples of the first are used");
}

std::string message_of(const IntakeNotice& n, const Config& config) {
  if (n.of_table) return table_message(n, config);
  const std::string node = fmt::format("node {} of {}", n.node, n.stream);
  switch (n.trouble) {
    case SequenceTrouble::two_senders:
      return two_senders_message(n, config);
    case SequenceTrouble::leaps:
      return n.over ? fmt::format("the numbers of {} go on without leaps", node)
                    : fmt::format(
                          "the numbers of {} leapt from {} to {}: it began anew, or they "
                          "are not its own",
                          node, n.from, n.to);
    case SequenceTrouble::duplicates:
      return n.over
                 ? fmt::format("the messages of {} come once again", node)
                 : fmt::format("{} messages of {} came twice, of {} in 10 s", n.count, node, n.of);
    case SequenceTrouble::losses:
      return n.over
                 ? fmt::format("the messages of {} come again", node)
                 : fmt::format("{} messages of {} were lost, of {} in 10 s", n.count, node, n.of);
  }
  return node;
}

constexpr const char* kIntakeKinds[] = {"two_senders", "sequence_leap", "duplicates", "losses",
                                        "channel_table"};

}  // namespace

std::optional<event_t> intake_event(const IntakeNotice& n, const Config& config,
                                    const RaisedEvents& raised, std::int64_t now_us) {
  const std::size_t kind = kind_of(n);
  event_t m{};
  m.time_us = m.since_us = now_us;
  m.id = kFirstIntakeId + static_cast<std::int64_t>(kind * config.pipeline.axes.size() + n.axis);
  const auto before = std::find_if(raised.all().begin(), raised.all().end(),
                                   [&](const event_t& e) { return e.id == m.id; });
  if (n.over && before == raised.all().end()) return std::nullopt;
  if (n.over) m.since_us = before->since_us;
  m.state = n.over ? event_state::cleared : event_state::raised;
  const bool grave = n.of_table ? n.told.name == config.pipeline.axes[n.axis].name
                                : n.trouble == SequenceTrouble::two_senders;
  m.severity = n.over ? severity::information : grave ? severity::alarm : severity::warning;
  m.kind = kIntakeKinds[kind];
  m.place = config.pipeline.axes[n.axis].name;
  m.value = n.of_table || n.over ? 0 : static_cast<double>(n.count);
  m.unit = n.of_table ? "" : "messages";
  m.message = message_of(n, config);
  return m;
}

}  // namespace framewatch::daemon
