// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_frame.h"
#include "drivers/can/can_intake.h"
#include "drivers/files/descriptor.h"
#include "drivers/files/file_problems.h"
#include "drivers/files/line_reader.h"

namespace framewatch::daemon {

/// Turns the CAN frames of a session's log into samples, frame by frame, in bounded memory.
class CanPlayback {
 public:
  /// map: of the configuration, must outlive this. file: the log, as candump writes it. name: of
  /// the log, for notes(). sink: gets the samples.
  CanPlayback(const drivers::CanMap& map, drivers::Descriptor file, std::string name,
              drivers::CanIntake::Sink sink);

  /// Returns the next frame; null at the end of the log.
  const drivers::CanFrame* next() const { return frame_ ? &*frame_ : nullptr; }
  /// Gives the samples of the next frame to the sink, at the end those that wait for more frames.
  void advance();
  /// Returns what was wrong with the log so far, one line for each of the first problems.
  std::vector<std::string> notes() const;

 private:
  void read();

  drivers::Descriptor file_;
  std::string name_;
  std::vector<drivers::Problem> problems_;
  drivers::FileProblems told_;
  drivers::LineReader lines_;
  drivers::CanIntake intake_;
  std::optional<drivers::CanFrame> frame_;
  int bus_ = -1;  ///< of the next frame
};

}  // namespace framewatch::daemon
