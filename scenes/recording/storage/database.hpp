#pragma once

// Tested by tests/scenes/recording/damage_test.cpp, tests/scenes/recording/crash_test.cpp.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <weft/core/error.hpp>

struct sqlite3;
struct sqlite3_stmt;

namespace weft::scenes {

/// What SQLite refused to do. what() is "file: doing: SQLite's message".
class DatabaseError : public Error {
 public:
  DatabaseError(const std::string& message, int code) : Error(message), code_(code) {}
  [[nodiscard]] int code() const { return code_; }  ///< SQLite's primary result code

 private:
  int code_;
};

/// One prepared SQL statement. Parameters count from 1, columns from 0, as in SQLite.
/// Column getters throw Error if the stored type is another one: a damaged file must not be
/// silently converted.
class Statement {
 public:
  Statement(sqlite3* connection, std::string_view sql, std::string file);

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);  ///< NaN becomes NULL (SQLite has no NaN)
  Statement& bind(int parameter, std::string_view value);
  Statement& bind(int parameter, std::span<const std::byte> value);

  /// Goes to the next row; false at the end.
  bool step();
  /// Runs a statement that returns no rows, and makes it ready for the next bind().
  void run();

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;  ///< NULL reads as NaN
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] std::vector<std::byte> blob(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  void check(int code) const;
  void require_type(int column, int type) const;

  sqlite3* connection_;
  std::string file_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// A connection to a SQLite database file. A file that is only read comes from a stranger: SQLite's
/// defensive settings are on, and a statement takes no more steps than a file of this size needs.
class Database {
 public:
  enum class Access {
    kReadWrite,          ///< the file must exist
    kReadOnly,           ///< with locks, together with a writer
    kReadOnlyUnlocked,   ///< no locks, no shared memory: a crashed recording in a read-only folder
    kReadOnlyImmutable,  ///< no locks and no journal: a file that nobody writes
  };
  Database(const std::filesystem::path& path, Access access);
  /// A new empty database that is never a file. name: for messages.
  [[nodiscard]] static Database in_memory(const std::string& name);

  /// The bytes of the file that this database is or would be.
  [[nodiscard]] std::string serialized() const;

  void execute(const std::string& sql);
  /// Throws Error unless the file has these tables and nothing else: no other column, no view, no
  /// trigger, no index. required and optional: their CREATE TABLE statements; comments and white
  /// space do not count.
  void require_schema(std::string_view required, std::string_view optional) const;
  [[nodiscard]] Statement prepare(std::string_view sql) const;
  /// First column of the first row.
  [[nodiscard]] std::int64_t query_integer(std::string_view sql) const;
  [[nodiscard]] std::string query_text(std::string_view sql) const;

 private:
  struct Close {
    void operator()(sqlite3* connection) const;
  };
  Database() = default;
  void guard_reading(const std::filesystem::path& path);

  std::string file_;
  /// Steps of SQLite's machine that the current statement may still take. Before the connection,
  /// which holds its address.
  std::unique_ptr<std::int64_t> steps_left_;
  std::int64_t steps_of_statement_ = 0;
  std::unique_ptr<sqlite3, Close> connection_;
};

}  // namespace weft::scenes
