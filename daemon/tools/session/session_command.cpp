#include "daemon/tools/session/session_command.h"

#include <framewatch/session_status_t.hpp>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/printable.h"
#include "daemon/base/process.h"
#include "daemon/monitor/service/command_client.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {

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

int send_session_command(const Config& config, const std::string& verb,
                         const SessionRequest& request) {
  const CommandAnswer answer = give_command(
      config, "record", {"SESSION_COMMAND", drivers::encoded(session_command(verb, request))});
  std::string problem = answer.problem;
  if (problem.empty()) {
    const auto status = drivers::decoded<session_status_t>(answer.bytes);
    problem = status ? status->refused : "the recorder's answer is not understood";
  }
  if (problem.empty()) return 0;
  fmt::print(stderr, "framewatch record: {}\n", printable(problem));
  return kFailed;
}

}  // namespace framewatch::daemon
