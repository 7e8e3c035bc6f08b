// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace framewatch::daemon {

/// Runs independent pieces of work on several threads and reports progress. The result of a piece
/// must not depend on its thread or the order. A piece may run further pieces; idle threads take
/// them.
class Workers {
 public:
  /// Called with the step's name, the pieces done and the number of pieces, by one thread at a
  /// time.
  using Progress = std::function<void(const std::string&, int, int)>;

  explicit Workers(int threads, Progress progress = {});
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Calls work(0) .. work(count - 1) once each and returns when all are done. Rethrows an
  /// exception of one of them after the others have ended.
  void run(const std::string& what, int count, const std::function<void(int)>& work) const;
  /// Does the same without reporting progress.
  void run_within(int count, const std::function<void(int)>& work) const;

 private:
  class Crew;
  std::unique_ptr<Crew> crew_;
  Progress progress_;
};

}  // namespace framewatch::daemon
