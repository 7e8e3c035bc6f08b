// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "tests/fuzz/input.h"

namespace framewatch::test {

/// A reader of foreign bytes, or code that uses its result.
struct FuzzTarget {
  const char* name;
  /// Must return for any bytes. A crash, a sanitizer's report, an exception, more than 10 s or
  /// more than 1 GiB is a finding.
  void (*run)(Bytes input);
  /// Returns initial inputs, made of files of the repository and of the program's own output.
  std::vector<std::string> (*seeds)();
};

extern const FuzzTarget kPacketTarget, kMessagesTarget, kPageTarget, kSamplesTarget;
extern const FuzzTarget kLogTarget, kRecordTarget, kMiniseedTarget, kMatTarget, kStationXmlTarget;
extern const FuzzTarget kCanTarget, kCandumpTarget, kVectorLogTarget, kDbcTarget;
extern const FuzzTarget kConfigTarget, kScenarioTarget, kExpectationTarget, kBaselineTarget;
extern const FuzzTarget kStateTarget, kDatabaseTarget, kSessionTarget;
extern const FuzzTarget kHttpTarget, kCommandTarget, kMatrixMarketTarget;

}  // namespace framewatch::test
