// SPDX-License-Identifier: MIT
#include "daemon/command_line/command_line.h"

int main(int argc, char** argv) {
  return framewatch::daemon::run_command_line(argc, argv);
}
