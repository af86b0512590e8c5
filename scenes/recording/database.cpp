#include <weft/scenes/recording/database.hpp>

#include <algorithm>
#include <limits>

#include <fmt/core.h>
#include <sqlite3.h>

#include <weft/custom_forces/core/error.hpp>

namespace weft::scenes {
namespace {

/// How long a reader waits for a writer's short exclusive moments [ms].
constexpr int kBusyTimeout = 5000;

[[noreturn]] void fail(sqlite3* connection, const std::string& file, int code) {
  const int primary = code & 0xff;
  std::string message = connection != nullptr ? sqlite3_errmsg(connection) : sqlite3_errstr(code);
  // Messages about a damaged schema quote it, lines and all.
  message.resize(std::min(message.find('\n'), message.size()));
  throw DatabaseError(fmt::format("{}: {}", file, message), primary);
}

/// SQLite URI of a path: absolute, so that names such as ":memory:" and "file:x" stay file names.
std::string file_uri(const std::filesystem::path& path, std::string_view options) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(path).string()) {
    if (c == '%' || c == '?' || c == '#') {
      uri += fmt::format("%{:02x}", static_cast<unsigned char>(c));
    } else {
      uri += c;
    }
  }
  return uri.append(options);
}

}  // namespace

Statement::Statement(sqlite3* connection, std::string_view sql, std::string file)
    : connection_(connection), file_(std::move(file)) {
  sqlite3_stmt* statement = nullptr;
  const int code =
      sqlite3_prepare_v2(connection, sql.data(), static_cast<int>(sql.size()), &statement, nullptr);
  statement_.reset(statement);
  check(code);
}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

void Statement::check(int code) const {
  if (code != SQLITE_OK) {
    fail(connection_, file_, code);
  }
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, double value) {
  check(sqlite3_bind_double(statement_.get(), parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view value) {
  check(sqlite3_bind_text64(statement_.get(), parameter, value.data(), value.size(),
                            SQLITE_TRANSIENT, SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind(int parameter, std::span<const std::byte> value) {
  check(sqlite3_bind_blob64(statement_.get(), parameter, value.data(), value.size(),
                            SQLITE_TRANSIENT));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) {
    return true;
  }
  if (code != SQLITE_DONE) {
    fail(connection_, file_, code);
  }
  return false;
}

void Statement::run() {
  while (step()) {
  }
  check(sqlite3_reset(statement_.get()));
}

void Statement::require_type(int column, int type) const {
  if (sqlite3_column_type(statement_.get(), column) != type) {
    throw Error(fmt::format("{}: column '{}' has a value of a wrong type: the file is damaged",
                            file_, sqlite3_column_name(statement_.get(), column)));
  }
}

std::int64_t Statement::integer(int column) const {
  require_type(column, SQLITE_INTEGER);
  return sqlite3_column_int64(statement_.get(), column);
}

double Statement::real(int column) const {
  if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  require_type(column, SQLITE_FLOAT);
  return sqlite3_column_double(statement_.get(), column);
}

std::string Statement::text(int column) const {
  require_type(column, SQLITE_TEXT);
  const auto* data = sqlite3_column_text(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return {reinterpret_cast<const char*>(data), static_cast<std::size_t>(size)};
}

std::vector<std::byte> Statement::blob(int column) const {
  require_type(column, SQLITE_BLOB);
  const auto* data = static_cast<const std::byte*>(sqlite3_column_blob(statement_.get(), column));
  return {data, data + sqlite3_column_bytes(statement_.get(), column)};
}

Database::Database(const std::filesystem::path& path, Access access) : file_(path.string()) {
  int flags = SQLITE_OPEN_URI;
  flags |= access == Access::kReadWrite ? SQLITE_OPEN_READWRITE : SQLITE_OPEN_READONLY;
  const std::string uri =
      file_uri(path, access == Access::kReadOnlyImmutable ? "?immutable=1" : "");
  const char* file_system = access == Access::kReadOnlyUnlocked ? "unix-none" : nullptr;
  sqlite3* connection = nullptr;
  const int code = sqlite3_open_v2(uri.c_str(), &connection, flags, file_system);
  connection_.reset(connection);
  if (code != SQLITE_OK) {
    fail(connection, file_, code);
  }
  sqlite3_busy_timeout(connection, kBusyTimeout);
  // Files come from strangers: no SQL functions from their schema, and every cell checked.
  execute("PRAGMA trusted_schema=OFF; PRAGMA cell_size_check=ON; PRAGMA mmap_size=0");
  if (access == Access::kReadOnlyUnlocked) {
    execute("PRAGMA locking_mode=EXCLUSIVE");  // keeps the index of the log in memory, not beside
                                               // the file
  }
}

void Database::Close::operator()(sqlite3* connection) const {
  sqlite3_close(connection);
}

void Database::execute(const std::string& sql) {
  const int code = sqlite3_exec(connection_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) {
    fail(connection_.get(), file_, code);
  }
}

Statement Database::prepare(std::string_view sql) const {
  return {connection_.get(), sql, file_};
}

std::int64_t Database::query_integer(std::string_view sql) const {
  Statement statement = prepare(sql);
  if (!statement.step()) {
    throw Error(fmt::format("{}: no value for '{}': the file is damaged", file_, sql));
  }
  return statement.integer(0);
}

std::string Database::query_text(std::string_view sql) const {
  Statement statement = prepare(sql);
  if (!statement.step()) {
    throw Error(fmt::format("{}: no value for '{}': the file is damaged", file_, sql));
  }
  return statement.text(0);
}

}  // namespace weft::scenes
