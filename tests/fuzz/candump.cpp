// SPDX-License-Identifier: MIT
// A log of `candump -l`.
#include "drivers/can/can_log.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

using drivers::CanFrame;

void read_candump_log(Bytes input) {
  const InputFile file(input);
  (void)drivers::looks_like_candump(file.path());
  std::vector<drivers::Problem> problems;
  const bool good = drivers::read_candump(
      file.path(),
      [](const CanFrame& frame, std::string_view interface) {
        const std::string line = drivers::candump_line(frame, interface);
        CanFrame again;
        std::string_view same;
        std::string rule;
        require(drivers::parse_candump_line(line, again, same, rule), "a line that is read again");
        require(same == interface && again.id == frame.id && again.data == frame.data &&
                    again.length == frame.length && again.stamp_us == frame.stamp_us,
                "the same frame");
      },
      problems);
  require(good == problems.empty(), "all of it or a problem");
}

std::vector<std::string> candump_seeds() {
  return {"(1631416514.717133) can0 0D0#A8FF00000000FF01\n(1631416514.727133) can0 080#\n",
          "(1631416514.717133) can1 18FEF100#0102030405060708\r\n(1631416515.0) vcan0 123#R\n",
          "(1631416514.717133) can0 123##1000102030405060708090A0B\n",
          "(1631416514.717133) can0 20000004#0000000000000000\n\n(1.000001) c 123#R8\n"};
}

}  // namespace

const FuzzTarget kCandumpTarget{"candump", &read_candump_log, &candump_seeds};

}  // namespace framewatch::test
