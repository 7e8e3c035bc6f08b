// SPDX-License-Identifier: MIT
#include "daemon/page/view/page_commands.h"

#include <utility>

namespace framewatch::daemon {

PageCommands::PageCommands(Give give, Failed failed)
    : give_(std::move(give)),
      failed_(std::move(failed)),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

bool PageCommands::add(PageCommand command) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (waiting_.size() == kMax) return false;
  waiting_.push_back(std::move(command));
  news_.notify_one();
  return true;
}

void PageCommands::work(const std::stop_token& stop) {
  for (;;) {
    PageCommand command;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      news_.wait(lock, stop, [this] { return !waiting_.empty(); });
      if (stop.stop_requested()) return;
      command = std::move(waiting_.front());
      waiting_.pop_front();
    }
    const CommandAnswer answer = give_(command.service, command.packet);
    if (!answer.problem.empty()) failed_(command, answer.problem);
  }
}

}  // namespace framewatch::daemon
