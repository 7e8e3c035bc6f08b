// SPDX-License-Identifier: MIT
#include "daemon/page/web/can_playback.h"

#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "drivers/can/can_log.h"

namespace framewatch::daemon {

CanPlayback::CanPlayback(const drivers::CanMap& map, drivers::Descriptor file, std::string name,
                         drivers::CanIntake::Sink sink)
    : file_(std::move(file)),
      name_(std::move(name)),
      told_(fmt::format("/proc/self/fd/{}", file_.get()), problems_),
      lines_(told_),
      intake_(map, std::move(sink)) {
  read();
}

/// Reads the next frame of a configured bus.
void CanPlayback::read() {
  std::string_view line, interface;
  std::string rule;
  drivers::CanFrame frame;
  frame_.reset();
  while (lines_.next(line)) {
    if (!drivers::parse_candump_line(line, frame, interface, rule)) {
      told_.add(lines_.number(), "the line " + rule + ": " + drivers::show_text(line));
      continue;
    }
    if (!lines_.line_ended()) {
      told_.add(lines_.number(), "the last line has no line end and may be cut off: left out");
      return;
    }
    bus_ = intake_.bus_of(interface);
    if (bus_ < 0) continue;
    frame_ = frame;
    return;
  }
}

void CanPlayback::advance() {
  if (!frame_) return;
  intake_.frame(bus_, *frame_);
  read();
  if (!frame_) intake_.finish();
}

std::vector<std::string> CanPlayback::notes() const {
  std::vector<std::string> out;
  for (const drivers::Problem& p : problems_)
    out.push_back(fmt::format("{}{}: {}", name_, p.where.substr(told_.path().size()), p.message));
  return out;
}

}  // namespace framewatch::daemon
