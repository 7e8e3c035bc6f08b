// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include "daemon/base/words.h"
#include "daemon/tools/diagnosis/diagnose_verdict.h"
#include "daemon/tools/diagnosis/evidence_section.h"
#include "daemon/tools/diagnosis/next_measurement.h"

namespace framewatch::daemon {

std::string diagnosis_text(const DiagnoseOutput& o) {
  const estimator::Diagnosis& d = o.diagnosis;
  std::vector<std::string> lines{gap_sentence(o), limit_sentence(o), damping_sentence(o),
                                 noise_sentence(o)};
  for (const estimator::FoundEffect& f : d.effects)
    lines.push_back(with_capital(effect_words(o, f)) + ": " + confidence_words(o, f) +
                    step_words(o, f) + ".");
  lines.push_back(leading_sentence(o));
  if (d.effects.empty()) lines.push_back(kind_sentence(o));
  for (const estimator::PlaceForce& f : d.evidence.forces) lines.push_back(force_sentence(o, f));
  lines.push_back(d.reason);
  if (const std::string next = next_measurement(o); !next.empty())
    lines.push_back("Measure next: " + next);
  std::string out = verdict_sentence(o) + "\n";
  for (const std::string& line : lines)
    if (!line.empty()) out += "  " + line + "\n";
  return out;
}

}  // namespace framewatch::daemon
