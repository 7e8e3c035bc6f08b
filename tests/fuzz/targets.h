// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "tests/fuzz/input.h"

namespace framewatch::test {

/// One reader of bytes from outside, or what is done with what it read.
struct FuzzTarget {
  const char* name;
  /// Must return, whatever the bytes: a crash, a sanitizer's report, an exception, more than 10 s
  /// or 1 GiB are findings.
  void (*run)(Bytes input);
  /// Inputs to begin with, made of files of the repository and what the program itself writes.
  std::vector<std::string> (*seeds)();
};

extern const FuzzTarget kPacketTarget, kMessagesTarget, kPageTarget, kSamplesTarget;
extern const FuzzTarget kLogTarget, kRecordTarget, kMiniseedTarget, kMatTarget, kStationXmlTarget;
extern const FuzzTarget kCanTarget, kCandumpTarget, kDbcTarget;
extern const FuzzTarget kConfigTarget, kScenarioTarget, kExpectationTarget, kBaselineTarget;
extern const FuzzTarget kStateTarget, kDatabaseTarget, kSessionTarget;
extern const FuzzTarget kHttpTarget, kCommandTarget;

}  // namespace framewatch::test
