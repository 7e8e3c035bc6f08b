// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace framewatch::fleet {

/// A value of a statement; empty: NULL.
using SqlValue = std::optional<std::string>;

/// Format values as PostgreSQL reads them: an array, or bytes as bytea.
std::string sql_array(std::span<const std::int32_t> values);
std::string sql_array(std::span<const std::int64_t> values);
std::string sql_array(std::span<const float> values);
std::string sql_array(std::span<const double> values);
std::string sql_array(const std::vector<std::string>& values);
std::string sql_bytes(std::span<const std::uint8_t> bytes);

/// Decode an int[], a real[], and an int or bigint of Database::query_binary(). Return an empty
/// list or 0 for other values.
std::vector<std::int32_t> integers_of(std::string_view array);
std::vector<float> reals_of(std::string_view array);
std::int64_t integer_of(std::string_view number);

/// A connection to PostgreSQL, used by one thread. Nothing throws: a call that fails returns false,
/// and error() says why. A connection that is lost is made again by the next open().
class Database {
 public:
  static constexpr int kConnect_s = 5;  ///< timeout of open()

  Database();
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// Connects unless connected. where: a connection string or URI of libpq; missing parts come from
  /// the environment (PGHOST, ...).
  [[nodiscard]] bool open(const std::string& where);
  bool is_open() const;
  void close();

  /// Runs statements without parameters, separated by ;.
  [[nodiscard]] bool execute(const std::string& sql);
  /// Runs one statement with the placeholders $1, $2, ...
  [[nodiscard]] bool run(const std::string& sql, const std::vector<SqlValue>& values);
  /// Runs one statement for each row of values, without waiting in between.
  [[nodiscard]] bool run_each(const std::string& sql,
                              const std::vector<std::vector<SqlValue>>& rows);
  using Row = std::vector<SqlValue>;
  /// Runs one statement and returns its rows as text. Returns nullopt on failure.
  std::optional<std::vector<Row>> query(const std::string& sql,
                                        const std::vector<SqlValue>& values = {});
  /// Does as query() but returns values in binary form, which is faster for many numbers.
  std::optional<std::vector<Row>> query_binary(const std::string& sql,
                                               const std::vector<SqlValue>& values = {});
  /// Runs `work` as one transaction; stores nothing if it returns false.
  [[nodiscard]] bool transaction(const std::function<bool()>& work);

  const std::string& error() const { return error_; }
  /// Returns true if the given values caused the last failure, so that a retry would fail too.
  bool is_of_values() const { return of_values_; }

 private:
  struct Connection;
  bool fail(const char* why, const char* sql_state = nullptr);
  std::optional<std::vector<Row>> ask(const std::string& sql, const std::vector<SqlValue>& values,
                                      bool binary);
  std::unique_ptr<Connection> connection_;
  std::string error_;
  bool of_values_ = false;
};

}  // namespace framewatch::fleet
