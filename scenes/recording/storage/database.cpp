#include <weft/scenes/recording/storage/database.hpp>

#include <algorithm>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/core.h>
#include <sqlite3.h>

#include <weft/core/error.hpp>
#include <weft/core/input_file.hpp>

namespace weft::scenes {
namespace {

/// How long a reader waits for a writer's short exclusive moments [ms].
constexpr int kBusyTimeout = 5000;

[[noreturn]] void fail(sqlite3* connection, const std::string& file, int code) {
  const int primary = code & 0xff;
  if (primary == SQLITE_INTERRUPT) {
    throw DatabaseError(
        fmt::format("{}: has more rows than a file of its size: the file is damaged", file),
        primary);
  }
  std::string message = connection != nullptr ? sqlite3_errmsg(connection) : sqlite3_errstr(code);
  // Messages about a damaged schema quote it, lines and all.
  message.resize(std::min(message.find('\n'), message.size()));
  throw DatabaseError(fmt::format("{}: {}", file, message), primary);
}

/// Steps of SQLite's machine between two looks at the clock.
constexpr int kStepsPerLook = 1000;

/// A row takes at least 6 bytes of a file and a scan about 15 steps for it. Pages that are shared by
/// several parents, which only a forged file has, make more rows than that.
constexpr std::int64_t kStepsPerByte = 4;
constexpr std::int64_t kLeastSteps = 1'000'000;

constexpr std::size_t kMaxShown = 40;  // of a name, in a message
constexpr int kMaxSqlLength = 10'000;  // of a statement or a table's definition

int count_down(void* left) {
  auto& steps = *static_cast<std::int64_t*>(left);
  steps -= kStepsPerLook;
  return steps < 0 ? 1 : 0;
}

/// A definition of SQL without comments, with one space where there is white space, none before and
/// after punctuation.
std::string plain_sql(std::string_view sql) {
  std::string plain;
  for (std::size_t i = 0; i < sql.size(); ++i) {
    if (sql.substr(i, 2) == "--") {
      i = std::min(sql.find('\n', i), sql.size());
      if (i == sql.size()) break;
    }
    const bool is_blank = sql[i] == ' ' || sql[i] == '\n' || sql[i] == '\t';
    const auto is_mark = [](char c) { return c == '(' || c == ')' || c == ','; };
    if (is_blank && (plain.empty() || plain.back() == ' ' || is_mark(plain.back()))) continue;
    if (is_mark(sql[i]) && plain.ends_with(' ')) plain.pop_back();
    plain += is_blank ? ' ' : sql[i];
  }
  while (plain.ends_with(' ')) plain.pop_back();
  return plain;
}

/// The statements of a text that end with a semicolon.
std::vector<std::string> statements_of(std::string_view sql) {
  std::vector<std::string> statements;
  const std::string plain = plain_sql(sql);
  for (std::size_t begin = 0; begin < plain.size();) {
    const std::size_t end = std::min(plain.find(';', begin), plain.size());
    statements.push_back(plain_sql(std::string_view(plain).substr(begin, end - begin)));
    begin = end + 1;
  }
  std::erase(statements, "");
  return statements;
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
  if (access != Access::kReadWrite) guard_reading(path);
  if (access == Access::kReadOnlyUnlocked) {
    execute("PRAGMA locking_mode=EXCLUSIVE");  // keeps the index of the log in memory, not beside
                                               // the file
  }
}

Database Database::in_memory(const std::string& name) {
  Database database;
  database.file_ = name;
  sqlite3* connection = nullptr;
  const int code = sqlite3_open(":memory:", &connection);
  database.connection_.reset(connection);
  if (code != SQLITE_OK) fail(connection, name, code);
  return database;
}

std::string Database::serialized() const {
  sqlite3_int64 size = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> bytes(
      sqlite3_serialize(connection_.get(), "main", &size, 0), sqlite3_free);
  if (bytes == nullptr) fail(nullptr, file_, SQLITE_NOMEM);
  return {reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size)};
}

void Database::Close::operator()(sqlite3* connection) const {
  sqlite3_close(connection);
}

void Database::execute(const std::string& sql) {
  if (steps_left_) *steps_left_ = steps_of_statement_;
  const int code = sqlite3_exec(connection_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) {
    fail(connection_.get(), file_, code);
  }
}

void Database::guard_reading(const std::filesystem::path& path) {
  sqlite3* const connection = connection_.get();
  for (const auto& [option, value] :
       {std::pair{SQLITE_DBCONFIG_DEFENSIVE, 1}, std::pair{SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
        std::pair{SQLITE_DBCONFIG_ENABLE_TRIGGER, 0}, std::pair{SQLITE_DBCONFIG_ENABLE_VIEW, 0},
        std::pair{SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0}}) {
    sqlite3_db_config(connection, option, value, nullptr);
  }
  sqlite3_limit(connection, SQLITE_LIMIT_LENGTH, static_cast<int>(kMaxInputSize));
  sqlite3_limit(connection, SQLITE_LIMIT_SQL_LENGTH, kMaxSqlLength);
  sqlite3_limit(connection, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_limit(connection, SQLITE_LIMIT_TRIGGER_DEPTH, 0);
  std::error_code ignored;
  std::uintmax_t size = 0;
  for (const char* suffix : {"", "-wal"}) {
    const std::uintmax_t part = std::filesystem::file_size(path.string() + suffix, ignored);
    if (!ignored) size += part;
  }
  steps_of_statement_ = kLeastSteps + kStepsPerByte * static_cast<std::int64_t>(size);
  steps_left_ = std::make_unique<std::int64_t>(steps_of_statement_);
  sqlite3_progress_handler(connection, kStepsPerLook, count_down, steps_left_.get());
}

void Database::require_schema(std::string_view required, std::string_view optional) const {
  std::vector<std::string> missing = statements_of(required);
  std::vector<std::string> allowed = statements_of(optional);
  Statement entries =
      prepare("SELECT type, name, coalesce(sql, ''), rootpage FROM sqlite_master ORDER BY rowid");
  while (entries.step()) {
    const std::string sql = plain_sql(entries.text(2));
    // SQLite itself makes the index of a key that is no number.
    const bool is_own_index = entries.text(0) == "index" && sql.empty() &&
                              entries.text(1).starts_with("sqlite_autoindex_");
    const bool is_table = entries.text(0) == "table" && entries.integer(3) > 0;
    if (is_own_index || (is_table && (std::erase(missing, sql) + std::erase(allowed, sql)) == 1)) {
      continue;
    }
    throw Error(fmt::format("{}: holds '{}', which is not as in a recording: the file is damaged",
                            file_, entries.text(1).substr(0, kMaxShown)));
  }
  if (missing.empty()) return;
  constexpr std::string_view kStart = "CREATE TABLE ";
  const std::string name = missing[0].substr(kStart.size(), missing[0].find('(') - kStart.size());
  throw Error(fmt::format("{}: has no table '{}': the file is damaged", file_, name));
}

Statement Database::prepare(std::string_view sql) const {
  if (steps_left_) *steps_left_ = steps_of_statement_;
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
