#include <weft/recorder/frame_marks.hpp>

#include <array>

#include <LinearMath/btVector3.h>

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Colors that the color-blind tell apart, without the pale ones (Okabe and Ito, 2008).
constexpr std::array<scenes::Rgb, 6> kColors = {
    {{213, 94, 0}, {0, 114, 178}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {20, 20, 20}}};

Matrix3X<float> matrix_of(std::span<const btVector3> points) {
  Matrix3X<float> matrix(3, std::ssize(points));
  for (Eigen::Index i = 0; i < matrix.cols(); ++i) {
    const btVector3& point = points[static_cast<std::size_t>(i)];
    matrix.col(i) = Eigen::Vector3f(static_cast<float>(point.x()), static_cast<float>(point.y()),
                                    static_cast<float>(point.z()));
  }
  return matrix;
}

}  // namespace

void FrameMarks::add(scenes::MarkKind kind, const std::string& name,
                     std::span<const btVector3> begins, std::span<const btVector3> ends) {
  const auto color = colors_.try_emplace(name, kColors[colors_.size() % kColors.size()]).first;
  scenes::Mark mark{kind, name, color->second, matrix_of(begins), matrix_of(ends)};
  scenes::check_mark(mark);
  marks_.push_back(std::move(mark));
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
