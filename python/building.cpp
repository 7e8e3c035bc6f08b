// SPDX-License-Identifier: MIT
#include "python/building.h"

#include <optional>
#include <utility>

#include "python/errors.h"

namespace framewatch::python {
namespace {

daemon::Config parsed(const std::string& path, const std::string& text) {
  std::vector<daemon::ConfigProblem> problems;
  std::optional<daemon::Config> config = daemon::parse_config(path, text, problems);
  if (!config) refuse(problems);
  return std::move(*config);
}

}  // namespace

Building::Building(std::string path, std::string text)
    : text_(std::move(text)), config_(parsed(path, text_)), table_(config_.pipeline.parameters()) {}

}  // namespace framewatch::python
