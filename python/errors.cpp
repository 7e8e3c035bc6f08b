// SPDX-License-Identifier: MIT
#include "python/errors.h"

#include "daemon/base/printable.h"

namespace framewatch::python {
namespace {

template <typename Problem>
std::vector<std::string> lines(const std::vector<Problem>& problems) {
  std::vector<std::string> out;
  for (const Problem& p : problems) out.push_back(p.where + ": " + p.message);
  return out;
}

}  // namespace

std::vector<std::string> lines_of(const std::vector<daemon::ConfigProblem>& problems) {
  return lines(problems);
}

void refuse(const std::vector<std::string>& problems) {
  std::string text;
  for (const std::string& p : problems) text += (text.empty() ? "" : "\n") + p;
  throw Error(daemon::printable_lines(text));
}

void refuse(const std::vector<daemon::ConfigProblem>& problems) {
  refuse(lines(problems));
}

void refuse(const std::vector<drivers::Problem>& problems) {
  refuse(lines(problems));
}

}  // namespace framewatch::python
