#pragma once

// Tested by tests/core/state_archive_test.cpp.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <weft/core/types.hpp>

namespace weft {

/// Writes the state of objects as bytes, or reads it back. Every object has one function
/// serialize(StateArchive&) for both directions, so that nothing can be written and then forgotten.
///
///   StateArchive writer = StateArchive::writer();
///   object.serialize(writer);
///   StateArchive reader = StateArchive::reader(writer.bytes());
///   object.serialize(reader);
///   reader.end();
///
/// Numbers keep their bits, little-endian. A reader trusts nothing: what ends too early, belongs to
/// another part or has another size than the object expects throws Error, which says where.
class StateArchive {
 public:
  /// memory: to write to, whatever was in it.
  [[nodiscard]] static StateArchive writer(std::vector<std::byte> memory = {}) {
    StateArchive archive;
    archive.written_ = std::move(memory);
    archive.written_.clear();
    return archive;
  }
  /// bytes must outlive the reader.
  [[nodiscard]] static StateArchive reader(std::span<const std::byte> bytes);

  [[nodiscard]] bool is_reading() const { return is_reading_; }
  /// All that a writer has written so far.
  [[nodiscard]] const std::vector<std::byte>& bytes() const { return written_; }
  [[nodiscard]] std::vector<std::byte> take() { return std::move(written_); }

  /// The beginning of a part of the state. A reader checks that it meets the same part.
  void part(std::string_view name);
  /// A reader must have read everything.
  void end() const;
  /// Throws Error: the part of the state has a value that the object cannot take.
  [[noreturn]] void refuse(const std::string& what) const;

  template <class Number>
  requires(std::is_arithmetic_v<Number> || std::is_enum_v<Number>) void value(Number& number) {
    raw(&number, sizeof number);
  }
  void value(bool& flag);
  void value(std::string& text);

  template <class Scalar, int kRows, int kColumns>
  void value(Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
    if constexpr (kRows == Eigen::Dynamic || kColumns == Eigen::Dynamic) {
      std::int64_t rows = matrix.rows();
      std::int64_t columns = matrix.cols();
      value(rows);
      value(columns);
      if (is_reading_) {
        check_count(rows, columns, sizeof(Scalar));
        if ((kRows != Eigen::Dynamic && rows != kRows) ||
            (kColumns != Eigen::Dynamic && columns != kColumns)) {
          refuse("a matrix of " + std::to_string(rows) + " x " + std::to_string(columns) +
                 ", expected other dimensions");
        }
        matrix.resize(rows, columns);
      }
    }
    raw(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(Scalar));
  }

  template <class Number>
  requires(std::is_arithmetic_v<Number> ||
           std::is_enum_v<Number>) void value(std::vector<Number>& numbers) {
    resize(numbers, sizeof(Number));
    raw(numbers.data(), numbers.size() * sizeof(Number));
  }
  void value(std::vector<std::string>& texts);
  /// Numbers of which both sides know how many they are.
  template <class Number, std::size_t kCount>
  requires(std::is_arithmetic_v<Number>) void values(std::span<Number, kCount> numbers) {
    raw(numbers.data(), numbers.size_bytes());
  }

  /// Something that may be missing: whether it is there, and what present(value) serializes of it.
  template <class Value, class Present>
  void optional(std::optional<Value>& value_or_none, const Present& present) {
    bool is_set = value_or_none.has_value();
    value(is_set);
    if (is_reading()) value_or_none = is_set ? std::optional<Value>(Value{}) : std::nullopt;
    if (is_set) present(*value_or_none);
  }
  /// A list whose elements each(element) serializes.
  template <class Element, class Each>
  void list(std::vector<Element>& elements, const Each& each) {
    resize(elements, 1);
    for (Element& element : elements) each(element);
  }

  /// Numbers many of which equal the one before, as masses of a grid or contact states: pairs of length and value.
  /// A reader wants as many as it has.
  template <class Number>
  void runs(std::span<Number> numbers) {
    std::size_t done = 0;
    while (done < numbers.size()) {
      std::uint32_t length = 1;
      Number number = numbers[done];
      if (!is_reading_) {
        while (done + length < numbers.size() && is_same(numbers[done + length], number)) ++length;
      }
      value(length);
      value(number);
      if (length == 0 || length > numbers.size() - done)
        refuse("a run of equal numbers is longer than expected");
      std::fill_n(numbers.begin() + static_cast<std::ptrdiff_t>(done), length, number);
      done += length;
    }
  }

  /// A value that both sides have already and that must be the same.
  template <class Number>
  void expect(Number own, const char* what) {
    Number stored = own;
    value(stored);
    if (stored == own) return;
    refuse(std::string(what) + " = " + std::to_string(stored) + ", expected " +
           std::to_string(own));
  }

 private:
  static_assert(std::endian::native == std::endian::little,
                "states are little-endian: another processor has to swap bytes in raw()");

  template <class Number>
  [[nodiscard]] static bool is_same(Number a, Number b) {
    if constexpr (std::is_same_v<Number, float>) {
      return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
    } else if constexpr (std::is_same_v<Number, double>) {
      return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
    } else {
      return a == b;
    }
  }
  template <class Element>
  void resize(std::vector<Element>& elements, std::size_t size) {
    auto count = static_cast<std::int64_t>(elements.size());
    value(count);
    if (!is_reading_) return;
    check_count(count, 1, size);
    elements.resize(static_cast<std::size_t>(count));
  }
  void raw(void* data, std::size_t size);
  void check_count(std::int64_t rows, std::int64_t columns, std::size_t size) const;

  bool is_reading_ = false;
  std::vector<std::byte> written_;
  std::span<const std::byte> read_;
  std::size_t position_ = 0;
  std::string part_ = "start";
};

}  // namespace weft
