// SPDX-License-Identifier: MIT
struct sqlite3;
struct sqlite3_stmt;
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace framewatch::daemon {

/// SQLite databases that were set aside since the program started.
struct SetAside {
  std::int64_t count = 0;
  std::string path;     ///< path of the last one; empty: there was no file any more
  std::string reason;   ///< why it was set aside
  std::string problem;  ///< why a database could not be set aside; else empty

  /// Returns "REASON: renamed it PATH and started a new one".
  std::string words() const;
};

/// Renames an unusable SQLite database and its write-ahead log to DATABASE.corrupt-TIME, so that a
/// new one can be created and a person can inspect the old one. Files that do not exist are no
/// problem. Keeps the three largest of the renamed files and removes the others. `now_us`: time of
/// the host's clock.
void set_aside_database(const std::string& database, std::int64_t now_us, const std::string& reason,
                        SetAside& out);

/// Failures of a database since its last transaction began, or since open().
struct SqliteFailure {
  bool any = false;
  bool corrupt = false;         ///< the file is damaged, not a database, or foreign
  std::string text;             ///< of the statement that failed first
  std::int64_t longest_us = 0;  ///< that a statement may take
  std::int64_t until_us = 0;    ///< steady clock: a statement that still runs then is interrupted

  void forget() {
    any = corrupt = false;
    text.clear();
  }
};

/// One prepared statement. Placeholders count from 1, columns from 0. NaN goes in and comes out as
/// NULL.
class SqliteStatement {
 public:
  /// `failure` belongs to the file: all of its statements share it.
  SqliteStatement(sqlite3_stmt* statement, SqliteFailure* failure)
      : statement_(statement, &finalize), failure_(failure) {}

  SqliteStatement& bind(int at, std::int64_t value);
  SqliteStatement& bind(int at, double value);
  SqliteStatement& bind(int at, std::string_view text);
  SqliteStatement& bind(int at, std::span<const double> values);

  /// Returns true if there is a row. Returns false at the end or after a failure. After a failure
  /// every later step of the file fails, and with them the transaction.
  bool row();
  /// Runs a statement that returns no rows, and resets it for other values.
  bool run();
  void again();

  bool null(int column) const;
  std::int64_t integer(int column) const;
  double number(int column) const;
  std::string text(int column) const;
  std::vector<double> numbers(int column) const;

 private:
  static void finalize(sqlite3_stmt* statement);
  int step();
  std::unique_ptr<sqlite3_stmt, void (*)(sqlite3_stmt*)> statement_;
  SqliteFailure* failure_;
};

/// A SQLite database, used by one thread. Nothing throws: a call that fails returns false, and
/// error() says why. Views, triggers and other SQL that a file contains are never executed. A
/// statement that gives no row for longest_s fails.
class SqliteFile {
 public:
  static constexpr double kLongest_s = 60;
  explicit SqliteFile(double longest_s = kLongest_s) : file_(nullptr, &close_file) {
    failure_.longest_us = static_cast<std::int64_t>(1e6 * longest_s);
  }

  /// Opens with a write-ahead log; a committed transaction is on the disk (synchronous = FULL).
  [[nodiscard]] bool open(const std::string& path);
  /// Fills an empty file that counts only when it is whole: fast, and lost with the machine's
  /// power.
  [[nodiscard]] bool open_new(const std::string& path);
  [[nodiscard]] bool open_to_read(const std::string& path);
  bool is_open() const { return file_ != nullptr; }
  /// Returns true if the path still names the file that was opened.
  bool in_place() const;
  void close() { file_.reset(); }

  [[nodiscard]] bool execute(const std::string& sql);
  /// A statement that does not fit the schema fails when it is used.
  SqliteStatement prepare(std::string_view sql);
  /// Runs `work` as one transaction: all of it or nothing is stored.
  [[nodiscard]] bool transaction(const std::function<bool()>& work);
  /// Returns true if a statement failed since the last transaction began, or since open().
  bool failed() const { return failure_.any; }
  /// Returns true if a call since open() failed because the file is damaged, or after condemn().
  bool corrupt() const { return failure_.corrupt; }
  /// Makes corrupt() true: the file is a database, but not one of framewatch.
  void condemn() { failure_.corrupt = true; }
  const std::string& error() const { return error_.empty() ? failure_.text : error_; }

 private:
  static void close_file(sqlite3* file);
  bool is_file(const std::string& path);
  bool open_to_write(const std::string& path, const std::string& settings);
  bool open_with(const std::string& path, int flags);
  bool fail();
  /// Device and number of the file that a path names; nullopt if it names none.
  using Identity = std::optional<std::pair<std::uint64_t, std::uint64_t>>;
  static Identity identity_of(const std::string& path);

  std::unique_ptr<sqlite3, void (*)(sqlite3*)> file_;
  SqliteFailure failure_;
  std::string error_;
  std::string path_;
  Identity identity_;
};

}  // namespace framewatch::daemon
