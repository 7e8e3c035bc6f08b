// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

/// A question about the building, in the dialogue and as an option of the command.
struct InitQuestion {
  const char* option;
  const char* title;  ///< title in the summary
  std::string (*ask)(const BuildingDraft&);
  bool (*applies)(const BuildingDraft&);
  std::string (*initial)(const BuildingDraft&);  ///< default; empty if an answer is required
  /// Stores the answer. Returns why it is invalid, or an empty text.
  std::string (*take)(const std::string& text, BuildingDraft&, ColumnCache&);
  std::string (*understood)(const BuildingDraft&);  ///< text of the understood answer
};

/// Returns the questions in the order of the dialogue. Each may use the answers before it.
std::span<const InitQuestion> init_questions();

}  // namespace framewatch::daemon
