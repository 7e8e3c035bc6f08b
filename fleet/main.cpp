// SPDX-License-Identifier: MIT
#include "fleet/command_line/fleet_command_line.h"

int main(int argc, char** argv) {
  return framewatch::fleet::run_fleet_command_line(argc, argv);
}
