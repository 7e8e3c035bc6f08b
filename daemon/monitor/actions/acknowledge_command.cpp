#include "daemon/monitor/actions/acknowledge_command.h"

#include <charconv>
#include <optional>
#include <system_error>
#include <vector>

#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>

#include <fmt/core.h>

#include "daemon/base/printable.h"
#include "daemon/config/config.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/events/acknowledge_messages.h"
#include "daemon/monitor/service/command_client.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr int kRefused = 1, kUnreachable = 2;

/// The number of an event; 0 for "all"; nothing when it is neither.
std::optional<std::int64_t> number_of(const std::string& event) {
  if (event == "all") return 0;
  std::int64_t id = 0;
  const char* const end = event.data() + event.size();
  const auto [at, error] = std::from_chars(event.data(), end, id);
  if (error != std::errc() || at != end || id == 0) return std::nullopt;
  return id;
}

int stop(int code, const std::string& why) {
  fmt::print(stderr, "framewatch acknowledge: {}\n", printable(why));
  return code;
}

}  // namespace

int acknowledge_command(const AcknowledgeArguments& a) {
  std::vector<ConfigProblem> problems;
  const std::optional<Config> config = load_config(a.config, problems);
  print_problems(problems);
  const std::optional<std::int64_t> id = number_of(a.event);
  if (!id)
    (void)stop(kUnreachable,
               fmt::format("'{}' is neither the number of an event nor all", a.event));
  if (!config || !id) return kUnreachable;
  const acknowledge_t request = acknowledge_request(*id, a.who, a.comment);
  const CommandAnswer answer =
      give_command(*config, "run", {"ACKNOWLEDGE", drivers::encoded(request)});
  if (!answer.answered) return stop(kUnreachable, answer.problem);
  if (!answer.problem.empty()) return stop(kRefused, answer.problem);
  const auto done = drivers::decoded<acknowledged_t>(answer.bytes);
  if (!done) return stop(kUnreachable, "the daemon's answer is not understood: another version?");
  if (!done->refused.empty()) return stop(kRefused, done->refused);
  for (std::size_t i = 0; i < done->id.size(); ++i)
    fmt::print("{}\n", printable(fmt::format("{} {} ({}) is acknowledged by {}", done->kind[i],
                                             done->place[i], done->id[i], done->who[i])));
  return 0;
}

}  // namespace framewatch::daemon
