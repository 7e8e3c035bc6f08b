// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/log.h"
#include "fleet/serve/commander.h"
#include "fleet/serve/people.h"
#include "fleet/store/database.h"

namespace framewatch::fleet {

/// A pool of database connections for the threads of a page. The database ends statements that take
/// longer than kLongest.
class DatabasePool {
 public:
  static constexpr const char* kLongest = "15s";

  explicit DatabasePool(std::string where) : where_(std::move(where)) {}

  /// A connection that is in use until this object is destroyed.
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
  /// Returns a connection. If it cannot be opened, its error() has the reason.
  Lent lend();

 private:
  const std::string where_;
  std::mutex mutex_;  ///< guards free_
  std::vector<std::unique_ptr<Database>> free_;
};

/// An admitted request of a person.
struct PageRequest {
  std::string method, path;
  std::map<std::string, std::string> arguments;
  std::string who;  ///< name of the person for the journal
  Role role = Role::viewer;

  std::string argument(const std::string& name) const;
};
struct PageAnswer {
  unsigned code = 200;
  std::string text, type;
};

/// Answers the requests of the page of many buildings (docs/fleet.md): the overview, a building,
/// its series, earthquakes, the journal, and commands of operators. May be called from any thread.
class FleetPages {
 public:
  static constexpr std::int64_t kFresh_us = 500'000;  ///< time that an overview is reused
  /// Queues a command; returns false when too many wait. Null without a hub.
  using Give = std::function<bool(CommandOrder)>;

  FleetPages(std::string database, Give give);

  PageAnswer answer(const PageRequest& request);
  /// Stores the result of a command in the journal.
  void note(const CommandResult& result);

 private:
  PageAnswer overview(const PageRequest& request);
  PageAnswer building(const PageRequest& request);
  PageAnswer series(const PageRequest& request);
  PageAnswer earthquake(const PageRequest& request);
  PageAnswer raw(const PageRequest& request);
  PageAnswer me(const PageRequest& request) const;
  PageAnswer command(const PageRequest& request);

  DatabasePool pool_;
  Give give_;
  std::mutex mutex_;  ///< guards the members below
  std::string overview_, version_;
  std::int64_t overview_us_ = INT64_MIN;  ///< steady clock
  daemon::RateLimitedLog failures_{daemon::LogLevel::warning};
};

}  // namespace framewatch::fleet
