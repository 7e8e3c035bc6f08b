#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

/// What one miniSEED record holds: the time of its first sample, since 1970, and the samples.
struct SeedPiece {
  std::int64_t start_us = 0;
  std::vector<double> values;
};

/// All of one SEED channel, in the order of the file.
struct SeedTrace {
  std::string name;
  double rate_hz = 0;
  std::vector<SeedPiece> pieces;
};

/// Puts the pieces in order of time and behind one another. What is missing is NaN and noted, what
/// is there twice and alike is taken once and noted. A problem are samples that are there twice
/// with different values, and pieces that lie between the steps of the others by more than a tenth
/// of one and more than the 100 us to which times of SEED may be rounded.
std::optional<Record> record_of_trace(SeedTrace trace, double unit_mps2, FileProblems& problems);

}  // namespace framewatch::drivers
