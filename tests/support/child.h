// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace framewatch::test {

/// A child process. The destructor kills it.
class Child {
 public:
  explicit Child(std::vector<std::string> arguments);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t pid() const { return pid_; }
  void signal(int number) const;
  /// Returns its exit code; 128 plus the signal if a signal ended it.
  int wait();
  int stop(int number) {
    signal(number);
    return wait();
  }

 private:
  pid_t pid_;
};

}  // namespace framewatch::test
