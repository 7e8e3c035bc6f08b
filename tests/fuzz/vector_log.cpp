// SPDX-License-Identifier: MIT
// A log of Vector's tools, as text (ASC) and binary (BLF).
#include "drivers/can/vector_log.h"
#include "drivers/can/can_log_file.h"
#include "tests/fuzz/targets.h"
#include "tests/support/vector_logs.h"

namespace framewatch::test {
namespace {

void take_any_frame(const drivers::CanFrame& frame, std::string_view interface) {
  require(drivers::is_fd_length(frame.length) && (frame.fd || frame.length <= 8),
          "a length that a frame can have");
  require(frame.id <= (frame.extended || frame.error ? 0x1FFFFFFFu : 0x7FFu), "an id of a frame");
  require(interface.starts_with("can"), "an interface");
  require(frame.stamp_us > -4'000'000'000'000'000 && frame.stamp_us < 16'000'000'000'000'000,
          "a time that sums do not overflow");
}

void read_vector_log(Bytes input) {
  const InputFile file(input);
  (void)drivers::can_log_format(file.path());
  (void)drivers::unread_can_log(file.path());
  for (const auto& reader : {drivers::read_asc, drivers::read_blf}) {
    std::vector<std::string> notes;
    std::vector<drivers::Problem> problems;
    const bool good = reader(file.path(), 60, take_any_frame, notes, problems);
    require(good == problems.empty(), "all of it or a problem");
    require(problems.size() <= 21, "the first problems and that they are the first");
  }
}

std::vector<std::string> vector_log_seeds() {
  drivers::CanFrame frame;
  frame.id = 0x181;
  frame.length = 8;
  std::string objects;
  for (unsigned i = 0; i < 5; ++i) objects += BlfWriter::message(frame, 1, 1'000'000 * i);
  objects += BlfWriter::object(100, 6'000'000, std::string(84, '\x01'));
  objects += BlfWriter::object(101, 700, std::string(104, '\x01'), 1, 2);
  objects += BlfWriter::object(73, 8'000'000, std::string(24, '\x01'));
  const std::string head =
      "date Fri Nov 27 11:30:05.250 pm 2026\nbase hex  timestamps absolute\n// version 9.0.0\n";
  return {BlfWriter::file(objects),
          BlfWriter::file(BlfWriter::container(objects)),
          BlfWriter::file(BlfWriter::container(objects.substr(0, 100), 0) +
                          BlfWriter::container(objects.substr(100), 0)),
          head + asc_line(frame, 1, "0.002367") + "2.5 1 ErrorFrame\n3.5 2 18EBFF00x Tx r 8\n",
          head + "0.1 CANFD 1 Rx 11 Name 1 0 9 12 01 02 03 04 05 06 07 08 09 0a 0b 0c 1 2 3000\n",
          "base dec timestamps relative\n0.000100 1 12 Rx d 2 17 255\n0.2 CANFD 2 Tx ErrorFrame\n",
          " (1700000000.000300)  can0  181   [8]  64 00\n",
          ";$FILEVERSION=1.1\n"};
}

}  // namespace

const FuzzTarget kVectorLogTarget{"vector_log", &read_vector_log, &vector_log_seeds};

}  // namespace framewatch::test
