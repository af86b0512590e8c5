#pragma once

// Tested by tests/scenes/format/scene_file_test.cpp.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include <weft/core/input_file.hpp>
#include <weft/core/types.hpp>

namespace weft::scenes {

/// Typed access to a parsed TOML text. Every value knows its path and place; every mistake becomes
/// a SceneError "file:line:column: path = value: message".

using Keys = std::span<const std::string_view>;

/// Where a text comes from. It outlives every value and table of the text.
struct TomlSource {
  std::string name;  ///< in messages: the path of the scene file
  FileSource files;  ///< those that the text may name; without it none
};

class TomlTable;

class TomlValue {
 public:
  TomlValue(const TomlSource& source, std::string path, const toml::node& node)
      : source_(&source), path_(std::move(path)), node_(&node) {}

  [[noreturn]] void fail(const std::string& message) const;
  /// Content of the file that this value names; expected says what the file is, "a picture".
  [[nodiscard]] std::string named_file(std::string_view expected) const;
  /// The files that the text may name, relative to its folder; none if it may name none.
  [[nodiscard]] const FileSource& files() const { return source_->files; }

  /// SI value of a quantity string with the dimension of unit; a bare number for unit "1".
  [[nodiscard]] double quantity(std::string_view unit) const;
  [[nodiscard]] double positive(std::string_view unit) const;
  [[nodiscard]] double non_negative(std::string_view unit) const;
  [[nodiscard]] int integer(int minimum, int maximum) const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] bool is_integer() const { return node_->is_integer(); }
  [[nodiscard]] bool is_table() const { return node_->is_table(); }
  [[nodiscard]] bool is_text() const { return node_->is_string(); }
  [[nodiscard]] std::string text() const;
  /// Letters, digits, '_' and '-', at most 64 of them.
  [[nodiscard]] std::string identifier() const;
  /// Index of the text in choices; what they are completes "unknown law, did you mean ...".
  [[nodiscard]] std::size_t choice(Keys choices, std::string_view what) const;
  /// Array of three quantities.
  [[nodiscard]] Vector3<double> vector(std::string_view unit) const;
  /// Array entries; count says how many there must be, expected what the array is.
  [[nodiscard]] std::vector<TomlValue> items(std::string_view expected,
                                             std::optional<std::size_t> count = {}) const;
  [[nodiscard]] TomlTable table(std::string_view expected) const;

 private:
  const TomlSource* source_;
  std::string path_;
  const toml::node* node_;
};

class TomlTable {
 public:
  TomlTable(const TomlSource& source, std::string path, const toml::table& table)
      : source_(&source), path_(std::move(path)), table_(&table) {}

  /// "path: message" at the start of the table.
  [[noreturn]] void fail(const std::string& message) const;

  /// Refuses every key that is not in keys, with a suggestion.
  void allow(Keys keys) const;

  [[nodiscard]] bool has(std::string_view key) const { return table_->contains(key); }
  [[nodiscard]] std::optional<TomlValue> find(std::string_view key) const;
  /// expected completes "missing key 'radius', expected ...".
  [[nodiscard]] TomlValue require(std::string_view key, const std::string& expected) const;
  /// The tables written [[key]]; empty if there is none.
  [[nodiscard]] std::vector<TomlTable> tables(std::string_view key) const;

 private:
  [[nodiscard]] std::string child_path(std::string_view key) const;

  const TomlSource* source_;
  std::string path_;
  const toml::table* table_;
};

}  // namespace weft::scenes
