#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace framewatch::daemon {

/// One prepared statement. Placeholders count from 1, columns from 0. NaN goes in and comes out as
/// NULL.
class SqliteStatement {
 public:
  /// `failed` belongs to the file: all of its statements share it.
  SqliteStatement(sqlite3_stmt* statement, bool* failed)
      : statement_(statement, &finalize), failed_(failed) {}

  SqliteStatement& bind(int at, std::int64_t value);
  SqliteStatement& bind(int at, double value);
  SqliteStatement& bind(int at, std::string_view text);
  SqliteStatement& bind(int at, std::span<const double> values);

  /// True: there is a row. False: there is none, or the step failed. After a failure every later
  /// step of the file fails too, and with them the transaction.
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
  bool* failed_;
};

/// A SQLite database, used by one thread. Nothing throws: a call that fails returns false, and
/// error() says why.
class SqliteFile {
 public:
  SqliteFile() : file_(nullptr, &close_file) {}

  /// Opens with a write-ahead log; a committed transaction is on the disk (synchronous = FULL).
  [[nodiscard]] bool open(const std::string& path);
  [[nodiscard]] bool open_to_read(const std::string& path);
  bool is_open() const { return file_ != nullptr; }
  void close() { file_.reset(); }

  [[nodiscard]] bool execute(const std::string& sql);
  /// A statement that does not fit the schema fails when it is used.
  SqliteStatement prepare(std::string_view sql);
  /// Runs `work` as one transaction: all of it or nothing is stored.
  [[nodiscard]] bool transaction(const std::function<bool()>& work);
  /// Whether a statement failed since the last transaction began, or since open().
  bool failed() const { return failed_; }
  const std::string& error() const { return error_; }

 private:
  static void close_file(sqlite3* file);
  bool fail();

  std::unique_ptr<sqlite3, void (*)(sqlite3*)> file_;
  bool failed_ = false;
  std::string error_;
};

}  // namespace framewatch::daemon
