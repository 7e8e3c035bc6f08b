// SPDX-License-Identifier: MIT
#include "daemon/tools/session/session_desk.h"

#include <framewatch/session_command_t.hpp>
#include <framewatch/session_status_t.hpp>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/printable.h"
#include "daemon/base/process.h"
#include "daemon/monitor/service/command_client.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {

SessionDesk::SessionDesk(const Config& config, Recorder& recorder)
    : config_(config),
      channel_(config.lcm.prefix + "SESSION_COMMAND"),
      recorder_(recorder),
      socket_(config, "record", [this](const CommandPacket& command, const std::string& user) {
        return obey(command, user);
      }) {}

void SessionDesk::poll() {
  socket_.poll(steady_clock_us());
}

void SessionDesk::heard(const void* data, std::size_t size, std::int64_t now_us) {
  if (!config_.lcm.commands) {
    ++not_obeyed_;
    return warnings_(now_us, fmt::format("ignored {} commands over LCM so far; set lcm.commands = "
                                         "true to allow them",
                                         not_obeyed_));
  }
  const auto command =
      drivers::decoded<session_command_t>({static_cast<const std::uint8_t*>(data), size});
  if (command) recorder_.obey(*command, "LCM", now_us);
}

CommandPacket SessionDesk::obey(const CommandPacket& command, const std::string& user) {
  if (command.channel != "SESSION_COMMAND")
    return refused("framewatch record takes session commands only");
  const auto wanted = drivers::decoded<session_command_t>(command.bytes);
  if (!wanted) return refused("cannot decode the command: do the versions differ?");
  const std::int64_t now_us = host_clock_us();
  recorder_.obey(*wanted, user, now_us);
  const session_status_t now = recorder_.status(now_us);
  session_status_t answer{};  // without the channels: it must fit a packet
  answer.time_us = now.time_us;
  answer.state = now.state;
  answer.session = now.session;
  answer.answered = now.answered;
  answer.refused = now.refused;
  return {"SESSION", drivers::encoded(answer)};
}

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
    problem = status ? status->refused : "cannot decode the recorder's answer";
  }
  if (problem.empty()) return 0;
  fmt::print(stderr, "framewatch record: {}\n", printable(problem));
  return kFailed;
}

}  // namespace framewatch::daemon
