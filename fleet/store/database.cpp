// SPDX-License-Identifier: MIT
#include "fleet/store/database.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include <fmt/core.h>
#include <libpq-fe.h>

namespace framewatch::fleet {
namespace {

using Result = std::unique_ptr<PGresult, decltype(&PQclear)>;

bool good(const PGresult* result) {
  const ExecStatusType status = PQresultStatus(result);
  return status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK;
}

std::vector<const char*> pointers(const std::vector<SqlValue>& values) {
  std::vector<const char*> out;
  for (const SqlValue& value : values) out.push_back(value ? value->c_str() : nullptr);
  return out;
}

std::string number_text(double value) {
  return std::isnan(value)   ? "NaN"
         : std::isinf(value) ? (value > 0 ? "Infinity" : "-Infinity")
                             : fmt::format("{}", value);
}

template <typename Values, typename Write>
std::string array_of(const Values& values, Write write) {
  std::string out = "{";
  for (const auto& value : values) {
    if (out.size() > 1) out += ',';
    out += write(value);
  }
  return out + "}";
}

constexpr std::size_t kWord = 4, kHead = 5 * kWord, kElement = 2 * kWord;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t out = 0;
  for (std::size_t i = 0; i < kWord; ++i)
    out = out << 8 | static_cast<unsigned char>(bytes[at + i]);
  return out;
}

template <typename Value>
std::vector<Value> values_of(std::string_view array) {
  std::vector<Value> out;
  if (array.size() < kHead || word_at(array, 0) != 1 || word_at(array, kWord) != 0) return out;
  const std::size_t count = word_at(array, 3 * kWord);
  if (array.size() != kHead + count * kElement) return out;
  out.reserve(count);
  for (std::size_t at = kHead; at < array.size(); at += kElement) {
    if (word_at(array, at) != kWord) return {};
    out.push_back(std::bit_cast<Value>(word_at(array, at + kWord)));
  }
  return out;
}

}  // namespace

std::string sql_array(std::span<const std::int32_t> values) {
  return array_of(values, [](auto v) { return std::to_string(v); });
}
std::string sql_array(std::span<const std::int64_t> values) {
  return array_of(values, [](auto v) { return std::to_string(v); });
}
std::string sql_array(std::span<const float> values) {
  return array_of(values, [](float v) {
    return std::isfinite(v) ? fmt::format("{}", v) : number_text(static_cast<double>(v));
  });
}
std::string sql_array(std::span<const double> values) {
  return array_of(values, number_text);
}
std::string sql_array(const std::vector<std::string>& values) {
  return array_of(values, [](const std::string& value) {
    std::string out = "\"";
    for (const char c : value) {
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
    return out + "\"";
  });
}

std::string sql_bytes(std::span<const std::uint8_t> bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string out = "\\x";
  out.reserve(2 + 2 * bytes.size());
  for (const std::uint8_t byte : bytes) {
    out += kDigits[byte >> 4];
    out += kDigits[byte & 15];
  }
  return out;
}

struct Database::Connection {
  std::unique_ptr<PGconn, decltype(&PQfinish)> pg{nullptr, &PQfinish};
};

Database::Database() : connection_(std::make_unique<Connection>()) {}
Database::~Database() = default;

/// Stores the first line of `why` as the error; further lines are advice. SQLSTATE class 22 is a
/// data exception, 23 an integrity constraint.
bool Database::fail(const char* why, const char* sql_state) {
  const std::string_view state = sql_state == nullptr ? "" : sql_state;
  of_values_ = state.starts_with("22") || state.starts_with("23");
  error_ = why == nullptr ? "" : why;
  error_ = error_.substr(0, error_.find('\n'));
  if (error_.empty()) error_ = "no connection";
  return false;
}

bool Database::open(const std::string& where) {
  if (is_open()) return true;
  const std::string wait = std::to_string(kConnect_s);
  const char* const keys[] = {"dbname", "connect_timeout", "application_name", "options", nullptr};
  const char* const values[] = {where.c_str(), wait.c_str(), "framewatch",
                                "-c client_min_messages=warning", nullptr};
  connection_->pg.reset(PQconnectdbParams(keys, values, 1));
  if (is_open()) return true;
  fail(PQerrorMessage(connection_->pg.get()));
  connection_->pg.reset();
  return false;
}

bool Database::is_open() const {
  return connection_->pg && PQstatus(connection_->pg.get()) == CONNECTION_OK;
}

void Database::close() {
  connection_->pg.reset();
}

bool Database::execute(const std::string& sql) {
  if (!is_open()) return fail(nullptr);
  const Result result(PQexec(connection_->pg.get(), sql.c_str()), &PQclear);
  return good(result.get()) || fail(PQerrorMessage(connection_->pg.get()));
}

bool Database::run(const std::string& sql, const std::vector<SqlValue>& values) {
  return query(sql, values).has_value();
}

std::optional<std::vector<Database::Row>> Database::query(const std::string& sql,
                                                          const std::vector<SqlValue>& values) {
  return ask(sql, values, false);
}

std::optional<std::vector<Database::Row>> Database::query_binary(
    const std::string& sql, const std::vector<SqlValue>& values) {
  return ask(sql, values, true);
}

std::optional<std::vector<Database::Row>> Database::ask(const std::string& sql,
                                                        const std::vector<SqlValue>& values,
                                                        bool binary) {
  if (!is_open()) {
    fail(nullptr);
    return std::nullopt;
  }
  const Result result(
      PQexecParams(connection_->pg.get(), sql.c_str(), static_cast<int>(values.size()), nullptr,
                   pointers(values).data(), nullptr, nullptr, binary ? 1 : 0),
      &PQclear);
  if (!good(result.get())) {
    fail(PQerrorMessage(connection_->pg.get()), PQresultErrorField(result.get(), PG_DIAG_SQLSTATE));
    return std::nullopt;
  }
  std::vector<Row> out;
  for (int r = 0; r < PQntuples(result.get()); ++r) {
    Row& row = out.emplace_back();
    for (int c = 0; c < PQnfields(result.get()); ++c)
      row.push_back(
          PQgetisnull(result.get(), r, c) != 0
              ? SqlValue()
              : SqlValue(std::string(PQgetvalue(result.get(), r, c),
                                     static_cast<std::size_t>(PQgetlength(result.get(), r, c)))));
  }
  return out;
}

bool Database::run_each(const std::string& sql, const std::vector<std::vector<SqlValue>>& rows) {
  if (rows.empty()) return true;
  if (!is_open()) return fail(nullptr);
  PGconn* const pg = connection_->pg.get();
  if (PQenterPipelineMode(pg) != 1) return fail(PQerrorMessage(pg));
  bool sent = PQsendPrepare(pg, "", sql.c_str(), 0, nullptr) == 1;
  for (const std::vector<SqlValue>& row : rows)
    sent = sent && PQsendQueryPrepared(pg, "", static_cast<int>(row.size()), pointers(row).data(),
                                       nullptr, nullptr, 0) == 1;
  sent = PQpipelineSync(pg) == 1 && sent;
  std::string why = sent ? "" : PQerrorMessage(pg);
  std::string state;
  bool well = sent;
  // The results of each statement end with a null pointer, all results with the synchronization.
  for (int nothing = 0; is_open() && nothing < 2;) {
    const Result result(PQgetResult(pg), &PQclear);
    if (!result) {
      ++nothing;
      continue;
    }
    nothing = 0;
    if (PQresultStatus(result.get()) == PGRES_PIPELINE_SYNC) break;
    if (good(result.get()) || !well) continue;
    well = false;
    why = PQresultErrorMessage(result.get());
    if (const char* code = PQresultErrorField(result.get(), PG_DIAG_SQLSTATE)) state = code;
  }
  if (is_open()) PQexitPipelineMode(pg);
  return (well && is_open()) || fail(why.c_str(), state.c_str());
}

bool Database::transaction(const std::function<bool()>& work) {
  if (!execute("BEGIN")) return false;
  if (work() && execute("COMMIT")) return true;
  const std::string why = error_;
  const bool of_values = of_values_;
  (void)execute("ROLLBACK");
  error_ = why;
  of_values_ = of_values;
  return false;
}

std::vector<std::int32_t> integers_of(std::string_view array) {
  return values_of<std::int32_t>(array);
}

std::vector<float> reals_of(std::string_view array) {
  return values_of<float>(array);
}

std::int64_t integer_of(std::string_view number) {
  if (number.size() == kWord) return static_cast<std::int32_t>(word_at(number, 0));
  if (number.size() != 2 * kWord) return 0;
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(word_at(number, 0)) << 32 |
                                   word_at(number, kWord));
}

}  // namespace framewatch::fleet
