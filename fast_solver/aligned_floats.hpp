#pragma once

#include <cstddef>
#include <memory>
#include <new>

namespace weft::fast {

/// Zeros at first, aligned to a cache line.
class AlignedFloats {
 public:
  AlignedFloats() = default;
  explicit AlignedFloats(std::size_t size)
      : values_(size == 0 ? nullptr : new (std::align_val_t{kAlignment}) float[size]()),
        size_(size) {}

  [[nodiscard]] float* data() { return values_.get(); }
  [[nodiscard]] const float* data() const { return values_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  static constexpr std::size_t kAlignment = 64;
  struct Delete {
    void operator()(float* values) const {
      ::operator delete[](values, std::align_val_t{kAlignment});
    }
  };
  std::unique_ptr<float[], Delete> values_;
  std::size_t size_ = 0;
};

}  // namespace weft::fast
