#pragma once

#include <optional>
#include <string_view>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"
#include "drivers/records/record_options.h"

// The readers of what networks of stations publish, one file each. All of them report to `problems`
// and return nothing when there is a problem.
namespace framewatch::drivers {

/// miniSEED 2: every SEED channel is one of the record, with its own name; `unit_mps2` is of a
/// count. Times are since 1970. Channels begin and end when they do: NaN where one has no sample.
std::optional<Record> read_mseed(const RecordOptions& options, FileProblems& problems);
/// Of the options only the zone, where the file does not say it.
std::optional<Record> read_cosmos(const RecordOptions& options, FileProblems& problems);
/// Whether a file of that first line is an accelerogram; others hold velocities, displacements.
bool is_smc_title(std::string_view first_line);
std::optional<Record> read_smc(FileProblems& problems);
std::optional<Record> read_knet(FileProblems& problems);
/// One channel; `unit_mps2` is of one of the file's, since few files say theirs as they should.
std::optional<Record> read_sac(const RecordOptions& options, FileProblems& problems);

}  // namespace framewatch::drivers
