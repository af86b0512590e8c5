#pragma once

// Tested by tests/fast_solver/prepared_solvers_test.cpp.

#include <atomic>
#include <memory>
#include <utility>

namespace weft::fast {

/// A value that copies have in common until one of them is to be changed (copy on write): what equal bodies only read is in the
/// cache once for all of them.
/// Threads  as a value of one's own: copies may be in different threads.
template <class T>
class SharedValue {
 public:
  SharedValue() : value_(std::make_shared<T>()) {}
  explicit SharedValue(T value) : value_(std::make_shared<T>(std::move(value))) {}

  [[nodiscard]] const T& operator*() const { return *value_; }
  [[nodiscard]] const T* operator->() const { return value_.get(); }
  /// To be changed. Pointers into what it was are those of the other copies, if there are any.
  [[nodiscard]] T& change() {
    if (value_.use_count() > 1) value_ = std::make_shared<T>(*value_);
    std::atomic_thread_fence(
        std::memory_order_acquire);  // after the last read of a copy that is gone
    return *value_;
  }

 private:
  std::shared_ptr<T> value_;
};

}  // namespace weft::fast
