#include <weft/playback/rendering/meshes/mark_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace weft::scenes {
namespace {

constexpr int kMarkSides = 8;
constexpr int kBallRows = 6;
constexpr double kRodRadius = 0.4;   // of a point's
constexpr double kTipRadius = 1.1;   // of a point's
constexpr double kTipLength = 3.5;   // of a point's radius
constexpr double kLongestTip = 0.5;  // of an arrow

void add_ball(SurfaceMesh& mesh, const Vector3<double>& center, double radius) {
  append_patch(mesh, kMarkSides, kBallRows, [&](double u, double v) {
    const double around = 2.0 * std::numbers::pi * u;
    const double up = std::numbers::pi * (v - 0.5);
    // u runs against the clock seen from above, so that u x v is the outside.
    const Vector3<double> normal(std::cos(up) * std::sin(around), std::sin(up),
                                 std::cos(up) * std::cos(around));
    return body_vertex(center + radius * normal, normal, {u, v});
  });
}

/// The side of a frustum around the way from one end to the other.
void add_side(SurfaceMesh& mesh, const Vector3<double>& from, double radius,
              const Vector3<double>& to, double end_radius) {
  const Vector3<double> along = (to - from).normalized();
  const Vector3<double> across = along.unitOrthogonal();
  const Vector3<double> up = along.cross(across);
  const double slope = (radius - end_radius) / (to - from).norm();
  append_patch(mesh, kMarkSides, 1, [&](double u, double v) {
    const double angle = 2.0 * std::numbers::pi * u;
    const Vector3<double> out = std::cos(angle) * across + std::sin(angle) * up;
    const Vector3<double> place =
        from + v * (to - from) + (radius + v * (end_radius - radius)) * out;
    return body_vertex(place, (out + slope * along).normalized(), {u, v});
  });
}

void add_rod(SurfaceMesh& mesh, const Vector3<double>& from, const Vector3<double>& to,
             double radius) {
  add_side(mesh, from, kRodRadius * radius, to, kRodRadius * radius);
}

void add_arrow(SurfaceMesh& mesh, const Vector3<double>& from, const Vector3<double>& to,
               double radius) {
  const double length = (to - from).norm();
  const double tip = std::min(kTipLength * radius, kLongestTip * length);
  const double tip_radius = kTipRadius * radius * tip / (kTipLength * radius);
  const Vector3<double> neck = to - tip / length * (to - from);
  add_rod(mesh, from, neck, radius);
  // The back of the tip, which is seen from behind the arrow.
  add_side(mesh, neck - 1e-3 * (to - from), 0.0, neck, tip_radius);
  add_side(mesh, neck, tip_radius, to, 0.0);
}

}  // namespace

SurfaceMesh mark_surface(const Mark& mark, double radius, const DrawLimits& limits) {
  SurfaceMesh mesh;
  const auto is_drawn = [&](const Vector3<double>& place) {
    return place.allFinite() && place.cwiseAbs().maxCoeff() <= limits.largest;
  };
  for (Eigen::Index i = 0; i < mark.from.cols(); ++i) {
    const Vector3<double> from = mark.from.col(i).cast<double>() - limits.origin;
    if (!is_drawn(from)) continue;
    if (mark.kind == MarkKind::kPoints) {
      add_ball(mesh, from, radius);
      continue;
    }
    const Vector3<double> to = mark.to.col(i).cast<double>() - limits.origin;
    // A force of zero has no direction.
    if (!is_drawn(to) || (to - from).norm() < 1e-3 * radius) continue;
    if (mark.kind == MarkKind::kLines) {
      add_rod(mesh, from, to, radius);
    } else {
      add_arrow(mesh, from, to, radius);
    }
  }
  return mesh;
}

}  // namespace weft::scenes
