#pragma once

#include <optional>
#include <string>

#include "fleet/message/message.h"
#include "fleet/store/database.h"

namespace framewatch::fleet {

/// Raw samples that a building sent on request.
struct FetchedSamples {
  std::string file;  ///< name that says the format
  Bytes miniseed;
};

/// Of a request to a building, when all pieces have come; else empty, with the reason: none has,
/// some have not, or why the building has nothing to send.
std::optional<FetchedSamples> read_fetched(Database& database, const std::string& building,
                                           const std::string& request, std::string& why);

}  // namespace framewatch::fleet
