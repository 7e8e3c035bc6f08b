// SPDX-License-Identifier: MIT
// fuzz TARGET [libFuzzer's arguments], fuzz TARGET --seeds FOLDER, fuzz --list. See
// CONTRIBUTING.md.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

const FuzzTarget* const kTargets[] = {
    &kPacketTarget,     &kMessagesTarget, &kPageTarget,        &kSamplesTarget,
    &kLogTarget,        &kRecordTarget,   &kMiniseedTarget,    &kMatTarget,
    &kStationXmlTarget, &kCanTarget,      &kCandumpTarget,     &kVectorLogTarget,
    &kDbcTarget,        &kConfigTarget,   &kScenarioTarget,    &kExpectationTarget,
    &kBaselineTarget,   &kStateTarget,    &kDatabaseTarget,    &kSessionTarget,
    &kHttpTarget,       &kCommandTarget,  &kMatrixMarketTarget};
/// libFuzzer restarts itself, for example to merge, with its own arguments and this one.
constexpr const char* kTargetVariable = "FRAMEWATCH_FUZZ_TARGET";
const FuzzTarget* chosen = nullptr;

const FuzzTarget* find(const std::string& name) {
  for (const FuzzTarget* target : kTargets)
    if (target->name == name) return target;
  return nullptr;
}

void write_seeds(const FuzzTarget& target, const std::string& folder) {
  int number = 0;
  for (const std::string& seed : target.seeds())
    std::ofstream(folder + "/seed-" + std::to_string(number++), std::ios::binary) << seed;
}

/// Removes the target's name from the arguments.
void choose(int* count, char*** arguments) {
  const char* inherited = std::getenv(kTargetVariable);
  const std::string name = inherited ? inherited : *count > 1 ? (*arguments)[1] : "";
  if (name == "--list") {
    for (const FuzzTarget* target : kTargets) std::puts(target->name);
    std::exit(0);
  }
  chosen = find(name);
  if (!chosen) {
    std::fprintf(stderr,
                 "usage: fuzz TARGET [--seeds FOLDER | argument of libFuzzer...]\n"
                 "       fuzz --list\n");
    std::exit(2);
  }
  if (inherited) return;
  ::setenv(kTargetVariable, chosen->name, 1);
  (*arguments)[1] = (*arguments)[0];
  ++*arguments;
  --*count;
  if (*count == 3 && (*arguments)[1] == std::string("--seeds")) {
    write_seeds(*chosen, (*arguments)[2]);
    std::exit(0);
  }
}

#ifndef __clang__
/// libFuzzer needs coverage that differs between inputs. Without clang's instrumentation, their
/// sizes serve instead.
__attribute__((section("__libfuzzer_extra_counters"))) std::uint8_t size_seen[4096];
#endif

}  // namespace
}  // namespace framewatch::test

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  framewatch::test::choose(count, arguments);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
#ifndef __clang__
  framewatch::test::size_seen[size % std::size(framewatch::test::size_seen)] = 1;
#endif
  framewatch::test::chosen->run({data, size});
  return 0;
}
