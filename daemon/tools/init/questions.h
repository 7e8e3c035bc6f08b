#pragma once

#include <span>
#include <string>

#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

/// One question about the building, in the dialogue and as an option of the command.
struct InitQuestion {
  const char* option;
  const char* title;  ///< in the summary
  std::string (*ask)(const BuildingDraft&);
  bool (*applies)(const BuildingDraft&);
  std::string (*initial)(const BuildingDraft&);  ///< default; empty: it must be answered
  /// Stores the answer. Returns why it is invalid, or an empty text.
  std::string (*take)(const std::string& text, BuildingDraft&, ColumnCache&);
  std::string (*understood)(const BuildingDraft&);  ///< what it was taken for
};

/// In the order in which they are asked: each knows the answers before it.
std::span<const InitQuestion> init_questions();

}  // namespace framewatch::daemon
