#pragma once

// Tested by tests/contract/law_contract_test.cpp.

#include <cmath>

#include <weft/core/eigen_alignment.hpp>

namespace weft {

/// A number and its derivative along one direction. Laws use it to multiply by their own stiffness
/// and damping matrices: the element's force is written once, as a template over the number.
/// It nests in any scalar, an automatically differentiated one too, and is as cheap as two numbers.
template <class Scalar>
struct Tangent {
  Scalar value{0};
  Scalar rate{0};

  Tangent() = default;
  // Implicit on purpose: constants stand in formulas as they are.
  Tangent(const Scalar& v) : value(v) {}  // NOLINT(google-explicit-constructor)
  Tangent(const Scalar& v, const Scalar& r) : value(v), rate(r) {}

  Tangent& operator+=(const Tangent& b) { return *this = *this + b; }
  Tangent& operator-=(const Tangent& b) { return *this = *this - b; }
  Tangent& operator*=(const Tangent& b) { return *this = *this * b; }
  Tangent& operator/=(const Tangent& b) { return *this = *this / b; }

  friend Tangent operator-(const Tangent& a) { return {Scalar(-a.value), Scalar(-a.rate)}; }
  friend Tangent operator+(const Tangent& a, const Tangent& b) {
    return {Scalar(a.value + b.value), Scalar(a.rate + b.rate)};
  }
  friend Tangent operator-(const Tangent& a, const Tangent& b) {
    return {Scalar(a.value - b.value), Scalar(a.rate - b.rate)};
  }
  friend Tangent operator*(const Tangent& a, const Tangent& b) {
    return {Scalar(a.value * b.value), Scalar(a.rate * b.value + a.value * b.rate)};
  }
  friend Tangent operator/(const Tangent& a, const Tangent& b) {
    const Scalar quotient = a.value / b.value;
    return {quotient, Scalar((a.rate - quotient * b.rate) / b.value)};
  }
  friend bool operator<(const Tangent& a, const Tangent& b) { return a.value < b.value; }
  friend bool operator>(const Tangent& a, const Tangent& b) { return a.value > b.value; }
  friend bool operator<=(const Tangent& a, const Tangent& b) { return a.value <= b.value; }
  friend bool operator>=(const Tangent& a, const Tangent& b) { return a.value >= b.value; }
  friend bool operator==(const Tangent& a, const Tangent& b) { return a.value == b.value; }
  friend bool operator!=(const Tangent& a, const Tangent& b) { return a.value != b.value; }
};

/// a or b, without a branch that a vector unit could not take.
template <class Number>
[[nodiscard]] Number choose(bool is_first, const Number& a, const Number& b) {
  return is_first ? a : b;
}
template <class Scalar>
[[nodiscard]] Tangent<Scalar> choose(bool is_first, const Tangent<Scalar>& a,
                                     const Tangent<Scalar>& b) {
  return {choose(is_first, a.value, b.value), choose(is_first, a.rate, b.rate)};
}

template <class Scalar>
[[nodiscard]] Tangent<Scalar> sqrt(const Tangent<Scalar>& a) {
  using std::sqrt;
  const Scalar root = sqrt(a.value);
  return {root, Scalar(a.rate / (Scalar(2) * root))};
}

template <class Scalar>
[[nodiscard]] Tangent<Scalar> atan2(const Tangent<Scalar>& y, const Tangent<Scalar>& x) {
  using std::atan2;
  return {Scalar(atan2(y.value, x.value)),
          Scalar((x.value * y.rate - y.value * x.rate) / (x.value * x.value + y.value * y.value))};
}

}  // namespace weft

template <class Scalar>
struct Eigen::NumTraits<weft::Tangent<Scalar>> : Eigen::NumTraits<Scalar> {
  using Real = weft::Tangent<Scalar>;
  using NonInteger = weft::Tangent<Scalar>;
  using Nested = weft::Tangent<Scalar>;
  using Literal = weft::Tangent<Scalar>;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 2,
    MulCost = 5
  };
};
