#pragma once

#include <cstdint>

#include <weft/core/types.hpp>

namespace weft::reference::testing {

/// Fixed numbers in [-1, 1], the same in every run and on every machine.
class Numbers {
 public:
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) / 4503599627370496.0 - 1.0;
  }
  Vector3<double> vector() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }

 private:
  std::uint64_t state_ = 42;
};

}  // namespace weft::reference::testing
