#pragma once

// Tested by tests/fast_solver/network/spring_network_test.cpp.

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace weft::fast {

/// To two lines of the cache, which processors fetch together: vectors of the processor cross no line, and what two
/// threads write is in lines apart.
inline constexpr std::size_t kAlignment = 128;

template <class T>
struct AlignedAllocator {
  using value_type = T;

  AlignedAllocator() = default;
  template <class Other>
  explicit AlignedAllocator(const AlignedAllocator<Other>& /*other*/) {}

  [[nodiscard]] T* allocate(std::size_t size) {
    return static_cast<T*>(::operator new (size * sizeof(T), std::align_val_t{kAlignment}));
  }
  void deallocate(T* values, std::size_t /*size*/) {
    ::operator delete (values, std::align_val_t{kAlignment});
  }
  friend bool operator==(const AlignedAllocator&, const AlignedAllocator&) { return true; }
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

/// An Eigen::Matrix whose numbers are aligned to kAlignment. (Eigen aligns to the vectors that a source file is compiled
/// for, which here are not those that run.)
template <class Scalar, int kRows, int kColumns>
class AlignedMatrix : public Eigen::Map<Eigen::Matrix<Scalar, kRows, kColumns>> {
 public:
  using Base = Eigen::Map<Eigen::Matrix<Scalar, kRows, kColumns>>;
  using Base::setZero;

  AlignedMatrix() : Base(nullptr, at_least(kRows), at_least(kColumns)) {}
  AlignedMatrix(Eigen::Index rows, Eigen::Index columns) : AlignedMatrix() {
    resize(rows, columns);
  }
  template <class Derived>
  AlignedMatrix(const Eigen::MatrixBase<Derived>& other)  // as Eigen's own
      : AlignedMatrix() {
    *this = other;
  }
  AlignedMatrix(const AlignedMatrix& other) : AlignedMatrix() { *this = other; }
  AlignedMatrix(AlignedMatrix&& other) noexcept : AlignedMatrix() { *this = std::move(other); }
  ~AlignedMatrix() = default;

  template <class Derived>
  AlignedMatrix& operator=(const Eigen::MatrixBase<Derived>& other) {
    resize(other.rows(), other.cols());
    Base::operator=(other.derived());
    return *this;
  }
  AlignedMatrix& operator=(const AlignedMatrix& other) {
    if (this != &other) *this = static_cast<const Eigen::MatrixBase<Base>&>(other);
    return *this;
  }
  AlignedMatrix& operator=(AlignedMatrix&& other) noexcept {
    const Eigen::Index rows = other.rows();
    const Eigen::Index columns = other.cols();
    values_.swap(other.values_);
    other.look_at(this->rows(), this->cols());
    look_at(rows, columns);
    return *this;
  }

  /// Zeros, if the size is another one.
  void resize(Eigen::Index rows, Eigen::Index columns) {
    if (rows == this->rows() && columns == this->cols()) return;
    values_.assign(static_cast<std::size_t>(rows * columns), Scalar(0));
    look_at(rows, columns);
  }
  void setZero(Eigen::Index rows, Eigen::Index columns) {
    resize(rows, columns);
    setZero();
  }

 private:
  [[nodiscard]] static constexpr Eigen::Index at_least(int size) {
    return size == Eigen::Dynamic ? 0 : size;
  }
  void look_at(Eigen::Index rows, Eigen::Index columns) {
    // As Eigen's manual has it for maps that look at something else.
    new (static_cast<Base*>(this)) Base(values_.data(), rows, columns);
  }

  AlignedVector<Scalar> values_;
};

}  // namespace weft::fast
