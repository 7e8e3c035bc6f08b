#include "fleet/serve/database_pool.h"

#include <utility>

#include <fmt/core.h>

#include "fleet/store/fleet_schema.h"

namespace framewatch::fleet {

DatabasePool::Lent DatabasePool::lend() {
  std::unique_ptr<Database> database;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!free_.empty()) {
      database = std::move(free_.back());
      free_.pop_back();
    }
  }
  if (!database) database = std::make_unique<Database>();
  if (database->is_open() || !database->open(where_)) return {*this, std::move(database)};
  // The tables are those of this program, whoever began first.
  if (!upgrade(*database).empty() ||
      !database->execute(fmt::format("SET statement_timeout = '{}'", kLongest)))
    database->close();
  return {*this, std::move(database)};
}

DatabasePool::Lent::~Lent() {
  if (!database_->is_open()) return;  // the next one opens anew
  const std::lock_guard<std::mutex> lock(pool_.mutex_);
  pool_.free_.push_back(std::move(database_));
}

}  // namespace framewatch::fleet
