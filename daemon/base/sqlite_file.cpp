// SPDX-License-Identifier: MIT
#include "daemon/base/sqlite_file.h"

#include <sqlite3.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/utc_time.h"
#include "drivers/files/input_file.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDamagedKept = 3;
constexpr const char* kDamagedEnding = ".corrupt-";
constexpr const char* kOfDatabase[] = {"-wal", "-shm", ""};

/// Returns an unused name for the database.
std::string name_aside(const std::string& database, std::int64_t now_us) {
  const std::string stamp = database + kDamagedEnding + utc_stamp(now_us);
  std::string name = stamp;
  std::error_code none;
  for (int i = 2; fs::exists(fs::symlink_status(name, none)); ++i)
    name = fmt::format("{}_{}", stamp, i);
  return name;
}

void remove_least(const fs::path& database) {
  const std::string begin = database.filename().string() + kDamagedEnding;
  const fs::path directory = database.has_parent_path() ? database.parent_path() : ".";
  std::vector<std::pair<std::int64_t, std::string>> found;
  std::error_code none;
  for (fs::directory_iterator at(directory, none), end; !none && at != end; at.increment(none)) {
    const std::string name = at->path().filename().string();
    if (!name.starts_with(begin) || name.ends_with("-wal") || name.ends_with("-shm")) continue;
    std::error_code failure;
    const auto bytes = at->file_size(failure);
    found.emplace_back(failure ? 0 : static_cast<std::int64_t>(bytes), at->path().string());
  }
  if (found.size() <= kDamagedKept) return;
  std::sort(found.rbegin(), found.rend());
  for (std::size_t i = kDamagedKept; i < found.size(); ++i)
    for (const char* beside : kOfDatabase) fs::remove(found[i].second + beside, none);
}

constexpr int kPatience_ms = 5000;  // while another process writes
constexpr int kOperationsBetweenLooks = 100'000;

/// Limits of one connection. A file of framewatch stays far below them.
constexpr std::pair<int, int> kLimits[] = {
    {SQLITE_LIMIT_LENGTH, 1 << 28},  // bytes of a row
    {SQLITE_LIMIT_SQL_LENGTH, 1 << 16}, {SQLITE_LIMIT_COLUMN, 64},
    {SQLITE_LIMIT_EXPR_DEPTH, 64},      {SQLITE_LIMIT_COMPOUND_SELECT, 8},
    {SQLITE_LIMIT_VDBE_OP, 25'000},     {SQLITE_LIMIT_ATTACHED, 0},
    {SQLITE_LIMIT_TRIGGER_DEPTH, 1},
};

/// Interrupts a statement whose time is over.
int is_too_long(void* failure) {
  return steady_clock_us() > static_cast<const SqliteFailure*>(failure)->until_us;
}

void allow_time(SqliteFailure& failure) {
  failure.until_us = steady_clock_us() + failure.longest_us;
}

bool means_corrupt(int result) {
  const int primary = result & 0xff;
  return primary == SQLITE_CORRUPT || primary == SQLITE_NOTADB;
}

}  // namespace

void set_aside_database(const std::string& database, std::int64_t now_us, const std::string& reason,
                        SetAside& out) {
  const std::string name = name_aside(database, now_us);
  bool renamed = false;
  out.problem.clear();
  // Rename the log first: SQLite would apply the old log to a new database.
  for (const char* beside : kOfDatabase) {
    if (std::rename((database + beside).c_str(), (name + beside).c_str()) == 0) {
      renamed = *beside == '\0';
      continue;
    }
    if (errno == ENOENT) continue;
    out.problem = fmt::format("{} is unusable ({}) and cannot be set aside: {}", database + beside,
                              reason, std::strerror(errno));
    return;
  }
  ++out.count;
  out.path = renamed ? name : "";
  out.reason = reason;
  remove_least(database);
}

std::string SetAside::words() const {
  return fmt::format("{}: {}started a new one", reason,
                     path.empty() ? "" : fmt::format("renamed it {} and ", path));
}

void SqliteStatement::finalize(sqlite3_stmt* statement) {
  sqlite3_finalize(statement);
}

SqliteStatement& SqliteStatement::bind(int at, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), at, value);
  return *this;
}

SqliteStatement& SqliteStatement::bind(int at, double value) {
  sqlite3_bind_double(statement_.get(), at, value);  // NaN becomes NULL
  return *this;
}

SqliteStatement& SqliteStatement::bind(int at, std::string_view text) {
  sqlite3_bind_text(statement_.get(), at, text.data(), static_cast<int>(text.size()),
                    SQLITE_TRANSIENT);
  return *this;
}

SqliteStatement& SqliteStatement::bind(int at, std::span<const double> values) {
  sqlite3_bind_blob(statement_.get(), at,
                    values.empty() ? "" : static_cast<const void*>(values.data()),
                    static_cast<int>(values.size_bytes()), SQLITE_TRANSIENT);
  return *this;
}

int SqliteStatement::step() {
  if (failure_->any) return SQLITE_ERROR;
  allow_time(*failure_);
  const int result = statement_ ? sqlite3_step(statement_.get()) : SQLITE_ERROR;
  if (result != SQLITE_ROW && result != SQLITE_DONE) {
    failure_->any = true;
    if (statement_) failure_->text = sqlite3_errmsg(sqlite3_db_handle(statement_.get()));
  }
  if (means_corrupt(result)) failure_->corrupt = true;
  return result;
}

bool SqliteStatement::row() {
  return step() == SQLITE_ROW;
}

bool SqliteStatement::run() {
  const bool good = step() == SQLITE_DONE;
  // A reset would discard the error.
  if (good) again();
  return good;
}

void SqliteStatement::again() {
  if (!statement_) return;
  sqlite3_reset(statement_.get());
  sqlite3_clear_bindings(statement_.get());
}

bool SqliteStatement::null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

std::int64_t SqliteStatement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double SqliteStatement::number(int column) const {
  return null(column) ? std::numeric_limits<double>::quiet_NaN()
                      : sqlite3_column_double(statement_.get(), column);
}

std::string SqliteStatement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return text == nullptr ? "" : text;
}

std::vector<double> SqliteStatement::numbers(int column) const {
  const void* bytes = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  std::vector<double> out(static_cast<std::size_t>(size) / sizeof(double));
  if (!out.empty()) std::memcpy(out.data(), bytes, out.size() * sizeof(double));
  return out;
}

void SqliteFile::close_file(sqlite3* file) {
  sqlite3_close(file);
}

bool SqliteFile::fail() {
  error_ = file_ ? sqlite3_errmsg(file_.get()) : "no memory";
  if (file_ && means_corrupt(sqlite3_errcode(file_.get()))) failure_.corrupt = true;
  return false;
}

/// SQLite would block on a FIFO without a writer.
bool SqliteFile::is_file(const std::string& path) {
  error_ = drivers::is_absent(path) ? "" : drivers::why_no_file(path);
  return error_.empty();
}

bool SqliteFile::open(const std::string& path) {
  // auto_vacuum has to be set before the first table.
  return open_to_write(path,
                       "PRAGMA auto_vacuum = INCREMENTAL; PRAGMA journal_mode = WAL;"
                       "PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON;");
}

bool SqliteFile::open_new(const std::string& path) {
  return open_to_write(path,
                       "PRAGMA auto_vacuum = INCREMENTAL; PRAGMA journal_mode = MEMORY;"
                       "PRAGMA synchronous = OFF; PRAGMA foreign_keys = ON;");
}

bool SqliteFile::open_to_write(const std::string& path, const std::string& settings) {
  if (!is_file(path)) return false;
  if (open_with(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE) && execute(settings)) {
    identity_ = identity_of(path);
    return true;
  }
  file_.reset();
  return false;
}

bool SqliteFile::open_to_read(const std::string& path) {
  if (!is_file(path) || !open_with(path, SQLITE_OPEN_READONLY)) return false;
  identity_ = identity_of(path);
  return true;
}

SqliteFile::Identity SqliteFile::identity_of(const std::string& path) {
  struct ::stat found {};
  if (::stat(path.c_str(), &found) != 0) return std::nullopt;
  return std::pair<std::uint64_t, std::uint64_t>(found.st_dev, found.st_ino);
}

bool SqliteFile::in_place() const {
  return identity_ == identity_of(path_);
}

bool SqliteFile::open_with(const std::string& path, int flags) {
  sqlite3* file = nullptr;
  const int opened = sqlite3_open_v2(path.c_str(), &file, flags, nullptr);
  file_.reset(file);
  failure_.forget();
  error_.clear();
  if (opened != SQLITE_OK) return fail();
  sqlite3_busy_timeout(file, kPatience_ms);
  // The file may be anybody's.
  sqlite3_db_config(file, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(file, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(file, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(file, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  for (const auto& [limit, value] : kLimits) sqlite3_limit(file, limit, value);
  sqlite3_progress_handler(file, kOperationsBetweenLooks, &is_too_long, &failure_);
  path_ = path;
  return true;
}

bool SqliteFile::execute(const std::string& sql) {
  allow_time(failure_);
  return (file_ &&
          sqlite3_exec(file_.get(), sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK) ||
         fail();
}

SqliteStatement SqliteFile::prepare(std::string_view sql) {
  allow_time(failure_);
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(file_.get(), sql.data(), static_cast<int>(sql.size()), &statement,
                         nullptr) != SQLITE_OK)
    fail();
  return {statement, &failure_};
}

bool SqliteFile::transaction(const std::function<bool()>& work) {
  failure_.any = false;
  if (!execute("BEGIN IMMEDIATE")) return false;
  if (work() && !failure_.any && execute("COMMIT")) return true;
  fail();
  const std::string why = std::move(error_);
  failure_.any = false;
  (void)execute("ROLLBACK");
  error_ = why;
  return false;
}

}  // namespace framewatch::daemon
