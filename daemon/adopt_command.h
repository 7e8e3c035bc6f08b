#pragma once

#include <string>

namespace framewatch::daemon {

struct AdoptArguments {
  std::string config, model;
  bool quiet = false;
};

/// framewatch adopt: puts a model where the configuration's [gap] wants it, if it is one of its
/// building. Exit code: 0 done, 2 bad usage, configuration or model; then nothing changed.
int adopt(const AdoptArguments& arguments);

}  // namespace framewatch::daemon
