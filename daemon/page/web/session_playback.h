// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/page/view/live_view.h"
#include "daemon/page/web/can_playback.h"
#include "drivers/files/descriptor.h"
#include "drivers/lcm/lcm_log.h"

namespace framewatch::daemon {

/// Plays the logs of a recorded session through a LiveView. Gives the server-sent events that
/// viewers of the live page would have read, each group after an event "time": seconds of the log.
/// The first event is "begin", the last is "end" with notes about damage. Works in small steps and
/// bounded memory, so that the thread of the server can call read().
class SessionPlayback {
 public:
  /// config: of the page, copied. folder: of all sessions. name: of one. Returns nullptr and sets
  /// `why`, a sentence for people, if the session cannot be shown on this page.
  static std::unique_ptr<SessionPlayback> open(const Config& config, const std::string& folder,
                                               const std::string& name, std::string& why);

  /// Copies the next bytes of the text to `buffer`. Returns their number; 0 at the end.
  std::size_t read(char* buffer, std::size_t size);

 private:
  /// One log and its next event.
  struct Log {
    std::string name;
    drivers::Descriptor file;
    drivers::LcmLogReader reader;
    drivers::LogEvent event;
    bool has = false;
  };

  explicit SessionPlayback(const Config& config);
  [[nodiscard]] bool add(const std::string& folder, const std::string& session,
                         const std::string& file);
  /// Returns false if the session has no log of CAN frames.
  [[nodiscard]] bool add_frames(const std::string& folder, const std::string& session);
  void next(Log& log);
  void advance();
  void flush();

  Config config_;
  std::vector<std::pair<std::string, std::vector<std::uint8_t>>> published_;
  LiveView view_;
  EventRing::Cursor cursor_;
  std::vector<std::unique_ptr<Log>> logs_;
  std::unique_ptr<CanPlayback> can_;  ///< null: the session has no CAN frames
  std::vector<std::string> notes_;
  std::int64_t first_us_ = 0, flush_us_ = 0;  ///< host clock
  std::string text_;                          ///< not read yet, from offset_ on
  std::size_t offset_ = 0;
  bool ended_ = false;
};

}  // namespace framewatch::daemon
