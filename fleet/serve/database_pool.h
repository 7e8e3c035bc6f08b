#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "fleet/store/database.h"

namespace framewatch::fleet {

/// Connections for the threads of a page, each used by one at a time. A statement that takes longer
/// than kLongest is ended by the database.
class DatabasePool {
 public:
  static constexpr const char* kLongest = "15s";

  explicit DatabasePool(std::string where) : where_(std::move(where)) {}

  /// A connection until this is destroyed.
  class Lent {
   public:
    Lent(DatabasePool& pool, std::unique_ptr<Database> database)
        : pool_(pool), database_(std::move(database)) {}
    ~Lent();
    Lent(const Lent&) = delete;
    Lent& operator=(const Lent&) = delete;
    Database& operator*() const { return *database_; }
    Database* operator->() const { return database_.get(); }

   private:
    DatabasePool& pool_;
    std::unique_ptr<Database> database_;
  };
  /// Opened where that is possible; else its error() says why not.
  Lent lend();

 private:
  const std::string where_;
  std::mutex mutex_;  ///< guards what is below
  std::vector<std::unique_ptr<Database>> free_;
};

}  // namespace framewatch::fleet
