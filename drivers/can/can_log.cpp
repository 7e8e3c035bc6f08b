#include "drivers/can/can_log.h"

#include "drivers/can/candump_line.h"
#include "drivers/files/file_problems.h"
#include "drivers/files/line_reader.h"

namespace framewatch::drivers {

bool looks_like_candump(const std::string& path) {
  std::vector<Problem> ignored;
  FileProblems problems(path, ignored);
  LineReader lines(problems);
  std::string_view line, interface;
  std::string rule;
  CanFrame frame;
  return lines.next(line) && parse_candump_line(line, frame, interface, rule);
}

bool read_candump(const std::string& path,
                  const std::function<void(const CanFrame&, std::string_view interface)>& take,
                  std::vector<Problem>& found) {
  FileProblems problems(path, found);
  LineReader lines(problems);
  std::string_view line, interface;
  std::string rule;
  CanFrame frame;
  while (lines.next(line)) {
    if (line.empty()) continue;
    if (parse_candump_line(line, frame, interface, rule))
      take(frame, interface);
    else
      problems.add(lines.number(), "the line " + rule + ": " + show_text(line));
  }
  return !problems.any();
}

bool CanLogWriter::write(const CanFrame& frame, std::string_view interface) {
  return out_.write(candump_line(frame, interface) + "\n");
}

}  // namespace framewatch::drivers
