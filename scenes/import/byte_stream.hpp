#pragma once

// Tested by tests/scenes/import/import_test.cpp.

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include <weft/core/error.hpp>

namespace weft::import {

/// Values one after the other, lists and texts with their lengths before them, for the way from one
/// process to its child.
class ByteWriter {
 public:
  void put(std::uint64_t value) { append(&value, sizeof value); }
  void put(const std::string& text) {
    put(static_cast<std::uint64_t>(text.size()));
    append(text.data(), text.size());
  }
  template <class Value>
  void put(const std::vector<Value>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    append(values.data(), values.size() * sizeof(Value));
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void append(const void* from, std::size_t size) {
    if (size > 0) bytes_.append(static_cast<const char*>(from), size);
  }
  std::string bytes_;
};

/// The inverse. Throws Error where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}
  /// A number of things that follow, of at least one byte each.
  [[nodiscard]] std::size_t count() {
    std::uint64_t value = 0;
    take(&value, sizeof value);
    if (value > bytes_.size() - position_) fail();
    return static_cast<std::size_t>(value);
  }
  [[nodiscard]] std::string text() {
    std::string result(count(), '\0');
    take(result.data(), result.size());
    return result;
  }
  template <class Value>
  [[nodiscard]] std::vector<Value> values() {
    const std::size_t number = count();
    if (number > (bytes_.size() - position_) / sizeof(Value)) fail();
    std::vector<Value> result(number);
    take(result.data(), number * sizeof(Value));
    return result;
  }

 private:
  [[noreturn]] static void fail() { throw Error("mesh data end too early"); }
  void take(void* to, std::size_t size) {
    if (size > bytes_.size() - position_) fail();
    if (size > 0) std::memcpy(to, bytes_.data() + position_, size);
    position_ += size;
  }
  const std::string& bytes_;
  std::size_t position_ = 0;
};

}  // namespace weft::import
