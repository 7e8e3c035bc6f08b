#include "daemon/session/session_command.h"

#include <utility>

#include <framewatch/session_status_t.hpp>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/random_id.h"
#include "drivers/base/encoded.h"
#include "drivers/lcm/lcm_source.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr int kTries = 10, kWait_ms = 300;

}  // namespace

session_command_t session_command(const std::string& verb, const SessionRequest& request) {
  session_command_t c{};
  c.id = random_id();
  c.verb = verb;
  c.test = request.test;
  c.operator_name = request.operator_name;
  c.notes = request.notes;
  c.length_s = request.length_s;
  c.trigger_mps2 = request.trigger_mps2;
  c.pre_trigger_s = request.pre_trigger_s;
  return c;
}

int send_session_command(lcm::LCM& lcm, const std::string& prefix, const std::string& verb,
                         const SessionRequest& request) {
  const session_command_t command = session_command(verb, request);
  const std::vector<std::uint8_t> bytes = drivers::encoded(command);
  std::optional<session_status_t> answer;
  drivers::LcmSource source(
      lcm, {prefix + "SESSION"}, 100,
      [&](const std::string&, const void* data, std::size_t size, std::int64_t) {
        auto status =
            drivers::decoded<session_status_t>({static_cast<const std::uint8_t*>(data), size});
        if (status && status->answered == command.id) answer = std::move(status);
      });
  for (int i = 0; i < kTries && !answer; ++i) {
    lcm.publish(prefix + "SESSION_COMMAND", bytes.data(), static_cast<unsigned>(bytes.size()));
    (void)source.handle(kWait_ms);
  }
  if (answer && answer->refused.empty()) return 0;
  fmt::print(
      stderr, "framewatch record: {}\n",
      answer ? answer->refused : "no recorder answers: is `framewatch record --standby` running?");
  return kFailed;
}

}  // namespace framewatch::daemon
