#include <weft/bridge/contact/surface/outward_faces.hpp>

#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace weft::bridge {
namespace {

btVector3 point(double x, double y, double z) {
  return {btScalar(x), btScalar(y), btScalar(z)};
}

class OutwardFaces : public ::testing::Test {
 protected:
  /// Two tetrahedra apart from each other, without faces.
  OutwardFaces() : body_(&info_, 8, kPoints, nullptr) {}

  void add_tetrahedron(int first) {
    const int corners[4][3] = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};  // of mixed winding
    for (const auto& c : corners) body_.appendFace(first + c[0], first + c[1], first + c[2]);
  }

  static constexpr int kNumFaces = 4;
  const btVector3 kPoints[8] = {point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), point(0, 0, 1),
                                point(5, 0, 0), point(6, 0, 0), point(5, 1, 0), point(5, 0, 1)};
  btSoftBodyWorldInfo info_;
  btSoftBody body_;
};

TEST_F(OutwardFaces, LeadAwayFromTheMiddleHoweverFacesAreWound) {
  add_tetrahedron(0);
  for (const bool is_swapped : {false, true}) {
    if (is_swapped) std::swap(body_.m_faces[1].m_n[0], body_.m_faces[1].m_n[1]);
    const std::vector<signed char> signs = outward_faces(body_);
    ASSERT_EQ(signs.size(), kNumFaces);
    const btVector3 middle = point(0.25, 0.25, 0.25);
    for (int f = 0; f < kNumFaces; ++f) {
      const auto& n = body_.m_faces[f].m_n;
      const btVector3 normal = btCross(n[1]->m_x - n[0]->m_x, n[2]->m_x - n[0]->m_x);
      EXPECT_GT(signs[static_cast<std::size_t>(f)] * btDot(normal, n[0]->m_x - middle), 0) << f;
    }
  }
}

TEST_F(OutwardFaces, AreNoneOfWhatIsOpenOrInPieces) {
  EXPECT_TRUE(outward_faces(body_).empty());
  body_.appendFace(0, 1, 2);
  body_.appendFace(0, 1, 3);
  EXPECT_TRUE(outward_faces(body_).empty());
  body_.appendFace(0, 2, 3);
  body_.appendFace(1, 2, 3);
  EXPECT_FALSE(outward_faces(body_).empty());
  add_tetrahedron(4);
  EXPECT_TRUE(outward_faces(body_).empty());
}

}  // namespace
}  // namespace weft::bridge
