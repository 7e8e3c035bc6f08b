#pragma once

#include <functional>
#include <memory>
#include <string>

namespace framewatch::daemon {

/// Runs independent pieces of work on several threads and reports progress. The result of a piece
/// must not depend on its thread or on the order. A piece may have pieces of its own run: threads
/// that have nothing else to do take them.
class Workers {
 public:
  /// (what is being done, pieces done, pieces in all); called by one thread at a time.
  using Progress = std::function<void(const std::string&, int, int)>;

  explicit Workers(int threads, Progress progress = {});
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Calls work(0) .. work(count - 1), each once; returns when all are done. Throws what one of
  /// them threw, when the others have ended.
  void run(const std::string& what, int count, const std::function<void(int)>& work) const;
  /// The same without progress.
  void run_within(int count, const std::function<void(int)>& work) const;

 private:
  class Crew;
  std::unique_ptr<Crew> crew_;
  Progress progress_;
};

}  // namespace framewatch::daemon
