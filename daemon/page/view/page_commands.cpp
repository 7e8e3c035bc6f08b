// SPDX-License-Identifier: MIT
#include "daemon/page/view/page_commands.h"

#include <utility>

namespace framewatch::daemon {

PageCommands::PageCommands(Give give, Failed failed)
    : give_(std::move(give)), failed_(std::move(failed)), thread_([this] { work(); }) {}

PageCommands::~PageCommands() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  news_.notify_one();
  thread_.join();
}

bool PageCommands::add(PageCommand command) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (waiting_.size() == kMax) return false;
  waiting_.push_back(std::move(command));
  news_.notify_one();
  return true;
}

void PageCommands::work() {
  for (;;) {
    PageCommand command;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      news_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
      if (stopping_) return;
      command = std::move(waiting_.front());
      waiting_.pop_front();
    }
    const CommandAnswer answer = give_(command.service, command.packet);
    if (!answer.problem.empty()) failed_(command, answer.problem);
  }
}

}  // namespace framewatch::daemon
