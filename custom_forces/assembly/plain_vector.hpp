#pragma once

// Tested by tests/custom_forces/assembly/edge_assembly_test.cpp.

namespace weft::forces {

/// Three numbers and nothing else, for the force of an element inside of vectorised loops. Eigen's
/// own vectors compute two of three doubles in one packet, which keeps the compiler from computing
/// the same component of many elements at once.
template <class Scalar>
struct PlainVector {
  Scalar x;
  Scalar y;
  Scalar z;

  [[nodiscard]] Scalar dot(const PlainVector& other) const {
    return Scalar(x * other.x + y * other.y + z * other.z);
  }
  [[nodiscard]] Scalar squared_norm() const { return dot(*this); }
  [[nodiscard]] PlainVector cross(const PlainVector& other) const {
    return {Scalar(y * other.z - z * other.y), Scalar(z * other.x - x * other.z),
            Scalar(x * other.y - y * other.x)};
  }

  friend PlainVector operator+(const PlainVector& a, const PlainVector& b) {
    return {Scalar(a.x + b.x), Scalar(a.y + b.y), Scalar(a.z + b.z)};
  }
  friend PlainVector operator-(const PlainVector& a, const PlainVector& b) {
    return {Scalar(a.x - b.x), Scalar(a.y - b.y), Scalar(a.z - b.z)};
  }
  friend PlainVector operator*(const Scalar& factor, const PlainVector& a) {
    return {Scalar(factor * a.x), Scalar(factor * a.y), Scalar(factor * a.z)};
  }
};

}  // namespace weft::forces
