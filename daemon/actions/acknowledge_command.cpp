#include "daemon/actions/acknowledge_command.h"

#include <charconv>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>

#include <fmt/core.h>
#include <lcm/lcm-cpp.hpp>

#include "daemon/config/config.h"
#include "daemon/config/config_problems.h"
#include "daemon/events/acknowledge_messages.h"
#include "drivers/base/encoded.h"
#include "drivers/lcm/lcm_source.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr int kRefused = 1, kUnreachable = 2, kTries = 10, kWait_ms = 300;

std::string user_name() {
  const char* name = std::getenv("USER");
  return name != nullptr && *name != '\0' ? name : "somebody";
}

/// The number of an event; 0 for "all"; nothing when it is neither.
std::optional<std::int64_t> number_of(const std::string& event) {
  if (event == "all") return 0;
  std::int64_t id = 0;
  const char* const end = event.data() + event.size();
  const auto [at, error] = std::from_chars(event.data(), end, id);
  if (error != std::errc() || at != end || id == 0) return std::nullopt;
  return id;
}

}  // namespace

int acknowledge_command(const AcknowledgeArguments& a) {
  std::vector<ConfigProblem> problems;
  const std::optional<Config> config = load_config(a.config, problems);
  print_problems(problems);
  const std::optional<std::int64_t> id = number_of(a.event);
  if (!id)
    fmt::print(stderr, "framewatch acknowledge: '{}' is neither the number of an event nor all\n",
               a.event);
  if (!config || !id) return kUnreachable;
  const std::string& url = a.url.empty() ? config->lcm.url : a.url;
  std::string error;
  const auto lcm = drivers::open_lcm(url, config->lcm.receive_buffer_bytes, error);
  if (!lcm) {
    fmt::print(stderr, "framewatch acknowledge: {}\n", error);
    return kUnreachable;
  }
  const acknowledge_t request =
      acknowledge_request(*id, a.who.empty() ? user_name() : a.who, a.comment);
  const std::vector<std::uint8_t> bytes = drivers::encoded(request);
  std::optional<acknowledged_t> answer;
  drivers::LcmSource source(
      *lcm, {config->lcm.prefix + "ACKNOWLEDGED"}, 100,
      [&](const std::string&, const void* data, std::size_t size, std::int64_t) {
        auto found =
            drivers::decoded<acknowledged_t>({static_cast<const std::uint8_t*>(data), size});
        if (found && found->answered == request.request) answer = std::move(found);
      });
  for (int i = 0; i < kTries && !answer; ++i) {
    lcm->publish(config->lcm.prefix + "ACKNOWLEDGE", bytes.data(),
                 static_cast<unsigned>(bytes.size()));
    (void)source.handle(kWait_ms);
  }
  if (!answer) {
    fmt::print(stderr,
               "framewatch acknowledge: nobody answers on {} with prefix {}: framewatch status\n",
               url, config->lcm.prefix);
    return kUnreachable;
  }
  if (!answer->refused.empty()) {
    fmt::print(stderr, "framewatch acknowledge: {}\n", answer->refused);
    return kRefused;
  }
  for (std::size_t i = 0; i < answer->id.size(); ++i)
    if (*id == 0 || answer->id[i] == *id)
      fmt::print("{} {} ({}) is acknowledged by {}\n", answer->kind[i], answer->place[i],
                 answer->id[i], answer->who[i]);
  return 0;
}

}  // namespace framewatch::daemon
