#include <weft/playback/exchange/import/obj_shape.hpp>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

std::string fault(const std::string& text) {
  try {
    (void)read_obj_shape(text, "a.obj");
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

// Assimp would weld the two equal points and give others the numbers of faces.
TEST(ObjShape, KeepsPointsAsTheyStand) {
  const ObjShape shape = read_obj_shape(
      "# a square\r\no sheet\nv 0 0 0\nv 1e0 0 -0.5 1.0\nvt 0 0\nv 1 1 0\nv 0 0 0\n"
      "usemtl x\nf 3/1/1 2//1 1\nf -1 -2 -3 -4",
      "a.obj");
  ASSERT_EQ(shape.points.cols(), 4);
  EXPECT_EQ(shape.points.col(1), Vector3<double>(1, 0, -0.5));
  EXPECT_EQ(shape.points.col(3), Vector3<double>(0, 0, 0));
  const std::vector<std::vector<int>> expected{{2, 1, 0}, {3, 2, 1, 0}};
  EXPECT_EQ(shape.faces, expected);
}

TEST(ObjShape, RefusesBadLinesWithTheirNumber) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(fault("v 0 0\n"), "a.obj:1: coordinate '' of a point, expected three finite numbers");
  EXPECT_EQ(fault("\nv 0 nan 1\n"),
            "a.obj:2: coordinate 'nan' of a point, expected three finite numbers");
  EXPECT_EQ(fault("v 0 0 1,5\n"),
            "a.obj:1: coordinate '1,5' of a point, expected three finite numbers");
  EXPECT_EQ(fault(points + "f 1 2 4\n"),
            "a.obj:4: corner '4' of a face, expected a number from 1 to 3, the points so far");
  EXPECT_EQ(fault(points + "f 0 1 2\n"),
            "a.obj:4: corner '0' of a face, expected a number from 1 to 3, the points so far");
  EXPECT_EQ(fault(points + "f 1 2 -4\n"),
            "a.obj:4: corner '-4' of a face, expected a number from 1 to 3, the points so far");
  EXPECT_EQ(fault(points + "f 1 2\n"), "a.obj:4: a face with 2 corners, expected at least 3");
  EXPECT_EQ(fault("f\n"), "a.obj:1: a face with 0 corners, expected at least 3");
  EXPECT_EQ(fault("o empty\n"), "a.obj: has no point, expected lines such as \"v 0 1 0\"");
}

}  // namespace
}  // namespace weft::scenes
