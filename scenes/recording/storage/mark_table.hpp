#pragma once

// Tested by tests/scenes/recording/mark_test.cpp.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <weft/scenes/recording/mark.hpp>
#include <weft/scenes/recording/storage/database.hpp>
#include <weft/scenes/recording/storage/format.hpp>

namespace weft::scenes {

/// The statement that makes table mark, which most recordings do not have.
extern const std::string_view kMarkSchema;

/// A row of table mark without its data.
struct MarkEntry {
  std::int64_t id = 0;
  std::int64_t frame = 0;
  std::string name;
  std::string kind;
  std::int64_t color = 0;  ///< 0xRRGGBB
  std::int64_t raw_bytes = 0;
  std::string hash;  ///< of the column data
};

/// Collects marks and notes until they are committed together with their frames.
class MarkWriter {
 public:
  void add(std::int64_t frame, std::span<const Mark> marks);
  void add(const Note& note);

  /// Writes what is pending; makes the table when the first mark comes.
  void write(Database& database);
  /// Sets the counts and hashes, if there is something to count.
  void update(Meta& meta) const;

 private:
  struct Row {
    MarkEntry entry;
    std::vector<std::byte> data;
  };
  std::vector<Row> marks_;   ///< that are not yet written
  std::vector<Note> notes_;  ///< likewise
  std::int64_t num_marks_ = 0;
  std::int64_t num_notes_ = 0;
  StreamHash mark_hash_;
  StreamHash note_hash_;
};

/// The rows of table mark, in their order; none if the header counts none. Throws Error that names the file if they do
/// not have their hash.
[[nodiscard]] std::vector<MarkEntry> read_mark_entries(const Database& database,
                                                       const Header& header,
                                                       const std::string& file);
[[nodiscard]] Mark read_mark(const Database& database, const MarkEntry& entry,
                             const std::string& file);
/// As read_mark_entries().
[[nodiscard]] std::vector<Note> read_notes(const Database& database, const Header& header,
                                           const std::string& file);

}  // namespace weft::scenes
