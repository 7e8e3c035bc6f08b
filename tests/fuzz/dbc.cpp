// SPDX-License-Identifier: MIT
// A DBC file, and numbers decoded from frames with it.
#include <array>

#include "drivers/can/can_frame.h"
#include "drivers/dbc/dbc.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

void read_dbc(Bytes input) {
  std::vector<drivers::Problem> problems;
  const auto dbc = drivers::parse_dbc("fuzz.dbc", text_of(input), problems);
  require(dbc.has_value() == problems.empty(), "messages or a problem");
  require(problems.size() <= 21, "the first problems and that they are the first");
  if (!dbc) return;
  for (const drivers::DbcMessage& message : dbc->messages) {
    if (!drivers::broken_rules(message).empty()) continue;
    require(message.length >= 0 && message.length <= 64, "a length that a frame can have");
    std::array<std::uint8_t, 64> data;
    data.fill(0xa5);
    const std::span<std::uint8_t> frame(data.data(), std::size_t(message.length));
    for (const drivers::DbcSignal& signal : message.signals) {
      require(drivers::fits(signal.field, message.length), "signals that fit");
      const double value = drivers::physical(signal.field, frame);
      (void)drivers::raw_integer(signal.field, frame);
      for (const drivers::CanSwitch& multiplexor : switches_of(message, signal)) {
        require(drivers::fits(multiplexor.field, message.length), "multiplexors that fit");
        require(!multiplexor.values.empty(), "multiplexors with values");
        (void)drivers::is_on(multiplexor, frame);
      }
      drivers::put_physical(signal.field, value, frame);
    }
  }
}

std::vector<std::string> dbc_seeds() {
  std::vector<std::string> out;
  for (const char* name : {"bosch_mm510", "epson_m_a552", "fd_block", "j1939_61485", "raw_int16",
                           "sbg_ellipse", "xsens_mti600"})
    out.push_back(repository_file(std::string("configs/can/") + name + ".dbc"));
  out.push_back(
      "BO_ 80 Multi: 8 A\n SG_ P M : 0|8@1+ (1,0) [0|0] \"\" A\n"
      " SG_ S m2M : 8|8@1+ (1,0) [0|0] \"\" A\n SG_ D m3 : 16|16@1- (1,0) [0|0] \"g\" A\n"
      "SG_MUL_VAL_ 80 S P 2-2;\nSG_MUL_VAL_ 80 D S 3-5, 7-7; // remark\n");
  return out;
}

}  // namespace

const FuzzTarget kDbcTarget{"dbc", &read_dbc, &dbc_seeds};

}  // namespace framewatch::test
