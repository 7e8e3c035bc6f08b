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

/// Numbers as PostgreSQL reads them: an array, or bytes as bytea.
std::string sql_array(std::span<const std::int32_t> values);
std::string sql_array(std::span<const std::int64_t> values);
std::string sql_array(std::span<const float> values);
std::string sql_array(std::span<const double> values);
std::string sql_array(const std::vector<std::string>& values);
std::string sql_bytes(std::span<const std::uint8_t> bytes);

/// What Database::query_binary() returns of an int[], a real[], an int or a bigint; of anything
/// else nothing, or 0.
std::vector<std::int32_t> integers_of(std::string_view array);
std::vector<float> reals_of(std::string_view array);
std::int64_t integer_of(std::string_view number);

/// A connection to PostgreSQL, used by one thread. Nothing throws: a call that fails returns false,
/// and error() says why. A connection that is lost is made again by the next open().
class Database {
 public:
  static constexpr int kConnect_s = 5;  ///< at most, for a connection

  Database();
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// `where`: a connection string or URI of libpq, whose parts may come from its environment
  /// (PGHOST, ...). Does nothing while the connection stands.
  [[nodiscard]] bool open(const std::string& where);
  bool is_open() const;
  void close();

  /// Statements without parameters, several with ; between them.
  [[nodiscard]] bool execute(const std::string& sql);
  /// One statement, whose placeholders are $1, $2, ...
  [[nodiscard]] bool run(const std::string& sql, const std::vector<SqlValue>& values);
  /// The same, once for each of many rows of values, without waiting for each.
  [[nodiscard]] bool run_each(const std::string& sql,
                              const std::vector<std::vector<SqlValue>>& rows);
  using Row = std::vector<SqlValue>;
  /// The same with what it returns. Empty on failure.
  std::optional<std::vector<Row>> query(const std::string& sql,
                                        const std::vector<SqlValue>& values = {});
  /// The same, with values as PostgreSQL has them in memory: for many numbers.
  std::optional<std::vector<Row>> query_binary(const std::string& sql,
                                               const std::vector<SqlValue>& values = {});
  /// Runs `work` as one transaction: all of it or nothing is stored.
  [[nodiscard]] bool transaction(const std::function<bool()>& work);

  const std::string& error() const { return error_; }
  /// Whether the last failure lies in values that were given: trying again would not help.
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
