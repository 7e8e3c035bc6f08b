// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"
#include "drivers/records/record_options.h"

// Readers of the formats of strong-motion networks, one file each. Each reads the file
// problems.path() and returns nullopt with its problems when the file breaks a rule of its format.
namespace framewatch::drivers {

/// Reads miniSEED 2. Every SEED channel becomes a channel of the same name; `unit_mps2` is the
/// m/s^2 of a count. Times are since 1970. Instants before the first and after the last sample of a
/// channel are NaN.
std::optional<Record> read_mseed(const RecordOptions& options, FileProblems& problems);

/// Reads COSMOS. Uses only the zone of the options, when the file does not state it.
std::optional<Record> read_cosmos(const RecordOptions& options, FileProblems& problems);

/// Returns true if this first line begins an SMC file of accelerations; SMC files can also hold
/// velocities and displacements.
bool is_smc_title(std::string_view first_line);
/// Reads SMC of the U.S. Geological Survey.
std::optional<Record> read_smc(FileProblems& problems);

/// Reads K-NET and KiK-net.
std::optional<Record> read_knet(FileProblems& problems);

/// Returns true if this first line begins a file of CSMIP, volume 1, 2 or 3.
bool is_csmip_title(std::string_view first_line);
/// Reads CSMIP volumes 1 and 2; volume 3 holds no accelerations. Uses only the zone of the options,
/// when the file's is unknown.
std::optional<Record> read_csmip(const RecordOptions& options, FileProblems& problems);

/// Returns true if this first line begins a file of ESM or ITACA.
bool is_esm_title(std::string_view first_line);
/// Reads accelerations of ESM and ITACA.
std::optional<Record> read_esm(FileProblems& problems);

/// Returns true if this first line begins a component of a GeoNet file.
bool is_geonet_title(std::string_view first_line);
/// Reads GeoNet V1A and V2A.
std::optional<Record> read_geonet(FileProblems& problems);

constexpr std::size_t kSacHeaderBytes = 632;
/// Returns true if the first kSacHeaderBytes of a file are the header of a SAC file.
bool is_sac_header(std::string_view bytes);
/// Reads one channel of SAC. `unit_mps2` is the m/s^2 of one value: few SAC files state their unit
/// reliably.
std::optional<Record> read_sac(const RecordOptions& options, FileProblems& problems);

}  // namespace framewatch::drivers
