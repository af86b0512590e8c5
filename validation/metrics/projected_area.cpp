#include <weft/validation/metrics/projected_area.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <Eigen/Geometry>

#include <weft/core/error.hpp>

namespace weft::validation {
namespace {

using Point = Eigen::Vector2d;

void check(const ProjectionRaster& raster) {
  if (!std::isfinite(raster.cell_size) || raster.cell_size <= 0) {
    throw InvalidArgument(fmt::format("projected area: cell_size = {} [m], expected > 0 and finite",
                                      raster.cell_size));
  }
  const double length = raster.direction.norm();
  if (!std::isfinite(length) || length <= 0 || !raster.center.allFinite()) {
    throw InvalidArgument(
        "projected area: direction or center, expected finite and a direction not zero");
  }
}

/// Node positions in the plane of the raster, measured in cells from its centre. 2 x n [-].
/// The axes depend on the direction alone, so that every projection along one direction has the same
/// raster.
Eigen::Matrix2Xd in_cells(ConstMatrix3XRef<double> positions, const ProjectionRaster& raster) {
  const Vector3<double> normal = raster.direction.normalized();
  const Vector3<double> first = normal.unitOrthogonal();
  const Vector3<double> second = normal.cross(first);
  Eigen::Matrix<double, 2, 3> projection;
  projection << first.transpose(), second.transpose();
  return projection * (positions.colwise() - raster.center) / raster.cell_size;
}

/// Cells of a bounding rectangle.
struct Bitmap {
  std::int64_t x0, y0;  ///< lower corner [cells]
  std::int64_t width, height;
  std::vector<std::uint8_t> cells;
};

/// Interval of the line y = const inside the triangle; empty if first > second.
std::pair<double, double> span_at(double y, const Point& a, const Point& b, const Point& c) {
  double low = INFINITY;
  double high = -INFINITY;
  const auto cross_edge = [&](const Point& p, const Point& q) {
    if (y < std::min(p.y(), q.y()) || y > std::max(p.y(), q.y())) return;
    const double x =
        p.y() == q.y() ? p.x() : p.x() + (y - p.y()) / (q.y() - p.y()) * (q.x() - p.x());
    low = std::min(low, x);
    high = std::max(high, x);
    if (p.y() == q.y()) {
      low = std::min(low, q.x());
      high = std::max(high, q.x());
    }
  };
  cross_edge(a, b);
  cross_edge(b, c);
  cross_edge(c, a);
  return {low, high};
}

/// Cell k covers [k, k + 1) and has its centre at k + 1/2.
void fill(Bitmap& bitmap, const Point& a, const Point& b, const Point& c) {
  const double bottom = std::min({a.y(), b.y(), c.y()});
  const double top = std::max({a.y(), b.y(), c.y()});
  const auto first_row = static_cast<std::int64_t>(std::ceil(bottom - 0.5));
  const auto last_row = static_cast<std::int64_t>(std::floor(top - 0.5));
  for (std::int64_t row = first_row; row <= last_row; ++row) {
    const auto [low, high] = span_at(static_cast<double>(row) + 0.5, a, b, c);
    if (!(low <= high)) continue;
    const auto first =
        std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(low - 0.5)), bitmap.x0);
    const auto last = std::min<std::int64_t>(static_cast<std::int64_t>(std::floor(high - 0.5)),
                                             bitmap.x0 + bitmap.width - 1);
    const auto start = bitmap.cells.begin() + (row - bitmap.y0) * bitmap.width;
    if (first <= last) std::fill(start + (first - bitmap.x0), start + (last - bitmap.x0 + 1), 1);
  }
}

}  // namespace

double cusick_cell_size(double specimen_area) {
  if (!std::isfinite(specimen_area) || specimen_area <= 0) {
    throw InvalidArgument(fmt::format(
        "projected area: specimen_area = {} [m^2], expected > 0 and finite", specimen_area));
  }
  constexpr double kCellsAcross = 1200.0;  // 0.30 m / 0.25 mm
  return 2.0 * std::sqrt(specimen_area / std::numbers::pi) / kCellsAcross;
}

std::optional<double> projected_area(ConstMatrix3XRef<double> positions, const Triangles& triangles,
                                     const ProjectionRaster& raster) {
  check(raster);
  if (triangles.cols() == 0) return 0.0;
  if (triangles.minCoeff() < 0 || triangles.maxCoeff() >= positions.cols()) {
    throw InvalidArgument(
        fmt::format("projected area: triangle corners = {} to {}, expected node indices 0 to {}",
                    triangles.minCoeff(), triangles.maxCoeff(), positions.cols() - 1));
  }
  if (!positions.allFinite()) return std::nullopt;
  const Eigen::Matrix2Xd points = in_cells(positions, raster);
  const Eigen::Array2d low = points.rowwise().minCoeff().array().floor();
  const Eigen::Array2d size = points.rowwise().maxCoeff().array().floor() - low + 1.0;
  // Beyond 2^52 cells from the centre neighboring cells are the same number.
  const double farthest = std::max(low.abs().maxCoeff(), (low + size).abs().maxCoeff());
  if (!(farthest < 0x1p52) || !(size.prod() <= kMaxProjectedCells)) return std::nullopt;
  Bitmap bitmap{static_cast<std::int64_t>(low[0]),
                static_cast<std::int64_t>(low[1]),
                static_cast<std::int64_t>(size[0]),
                static_cast<std::int64_t>(size[1]),
                {}};
  bitmap.cells.assign(static_cast<std::size_t>(bitmap.width * bitmap.height), 0);
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    fill(bitmap, points.col(triangles(0, t)), points.col(triangles(1, t)),
         points.col(triangles(2, t)));
  }
  const auto covered = std::count(bitmap.cells.begin(), bitmap.cells.end(), std::uint8_t{1});
  return static_cast<double>(covered) * raster.cell_size * raster.cell_size;
}

double disc_area(double radius, const ProjectionRaster& raster) {
  check(raster);
  const double cells = radius / raster.cell_size;
  if (!(radius >= 0) || !(4.0 * cells * cells <= kMaxProjectedCells)) {
    throw InvalidArgument(fmt::format(
        "projected area: radius = {} [m], expected >= 0 and at most {} cells of {} m across",
        radius, std::sqrt(kMaxProjectedCells), raster.cell_size));
  }
  double covered = 0.0;
  const auto last_row = static_cast<std::int64_t>(std::floor(cells));
  for (std::int64_t row = 0; row <= last_row; ++row) {
    const double y = static_cast<double>(row) + 0.5;
    if (y > cells) break;
    // Centres at 1/2, 3/2, ... up to the half chord; four quadrants.
    covered += 4.0 * std::floor(std::sqrt(cells * cells - y * y) + 0.5);
  }
  return covered * raster.cell_size * raster.cell_size;
}

}  // namespace weft::validation
