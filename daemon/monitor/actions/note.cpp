// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/note.h"

#include <algorithm>
#include <cctype>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/printable.h"
#include "daemon/base/utc_time.h"
#include "daemon/config/config.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/actions/acknowledge.h"
#include "drivers/files/encoded.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxNote = 500;  // bytes, as of a comment
constexpr int kNoNote = 2;

bool is_blank(const std::string& text) {
  return std::ranges::all_of(text, [](unsigned char c) { return std::isspace(c) != 0; });
}

int say(int code, const std::string& why) {
  fmt::print(stderr, "framewatch note: {}\n", printable(why));
  return code;
}

}  // namespace

std::optional<Note> note_of(const acknowledge_t& request, const std::string& user,
                            std::int64_t now_us, std::string& refused) {
  refused.clear();
  if (request.id != kPlainNote && request.id != kMaintenance)
    refused = fmt::format("{} is an unknown sort of note: is the program from another version?",
                          request.id);
  else if (is_blank(request.comment))
    refused = "a note needs a text";
  else if (request.comment.size() > kMaxNote)
    refused = fmt::format("a note has at most {} bytes, not {}", kMaxNote, request.comment.size());
  else if (request.time_us < 0 || request.time_us > now_us + kDay_us)
    refused = fmt::format("a note is about the past, not about {}", utc_text(request.time_us));
  if (!refused.empty()) return std::nullopt;
  Note out;
  out.event.id = request.request;
  out.event.kind = request.id == kMaintenance ? kMaintenanceKind : kNoteKind;
  out.by = {request.time_us, who_text(user, request.who), printable(request.comment, kMaxNote)};
  return out;
}

int note_command(const NoteArguments& a) {
  std::vector<ConfigProblem> problems;
  const std::optional<Config> config = load_config(a.config, problems);
  print_problems(problems);
  const std::optional<std::int64_t> at_us = a.at.empty() ? host_clock_us() : read_utc(a.at);
  if (!at_us)
    (void)say(kNoNote, fmt::format("--at: '{}' is not a time such as 2026-11-28 or "
                                   "2026-11-28T14:30:00Z",
                                   a.at));
  if (!config || !at_us) return kNoNote;
  acknowledge_t request =
      acknowledge_request(a.maintenance ? kMaintenance : kPlainNote, a.who, a.text);
  request.time_us = *at_us;
  RefusedCommand refused;
  const auto done = ask_daemon(*config, {kNoteCommand, drivers::encoded(request)}, refused);
  if (!done) return say(refused.exit_code, refused.why);
  if (done->id.size() != 1)
    return say(kNoNote, "cannot read the daemon's answer: is it another version?");
  fmt::print("{}\n",
             printable(fmt::format("{} of {} by {}: {}", done->kind[0], utc_text(done->since_us[0]),
                                   done->who[0], done->comment[0])));
  return 0;
}

}  // namespace framewatch::daemon
