// SPDX-License-Identifier: MIT
#include "tests/support/child.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace framewatch::test {

Child::Child(std::vector<std::string> arguments) : pid_(::fork()) {
  if (pid_ != 0) return;
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execv(pointers[0], pointers.data());
  ::_exit(127);
}

Child::~Child() {
  if (pid_ > 0) stop(SIGKILL);
}

void Child::signal(int number) const {
  if (pid_ > 0) ::kill(pid_, number);  // -1 would be every process there is
}

int Child::wait() {
  if (pid_ <= 0) return -1;
  int status = 0;
  ::waitpid(pid_, &status, 0);
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace framewatch::test
