#include <weft/validation/metrics/drape.hpp>

#include <fmt/core.h>
#include <Eigen/Geometry>

#include <weft/core/error.hpp>

namespace weft::validation {
namespace {

/// Sum of the oriented triangle areas: normal and, for a flat mesh, exact area [m^2].
Vector3<double> area_vector(const ClothMesh& mesh) {
  Vector3<double> sum(0, 0, 0);
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Vector3<double> a = mesh.rest_positions.col(mesh.triangles(0, t));
    const Vector3<double> b = mesh.rest_positions.col(mesh.triangles(1, t));
    const Vector3<double> c = mesh.rest_positions.col(mesh.triangles(2, t));
    sum += 0.5 * (b - a).cross(c - a);
  }
  return sum;
}

double rest_area(const ClothMesh& mesh, const Vector3<double>& normal, const DrapeSetup& setup,
                 double cell_size) {
  // A specimen that lies flat is counted on the very raster of its projection; one that hangs or leans
  // on its own.
  constexpr double kFlatCosine = 1.0 - 1e-12;  // 1e-6 rad, the rounding of hand-written axes
  const bool flat = std::abs(normal.normalized().dot(setup.up.normalized())) >= kFlatCosine;
  const ProjectionRaster raster =
      flat ? ProjectionRaster{setup.up, setup.support_center, cell_size}
           : ProjectionRaster{normal, mesh.rest_positions.rowwise().mean(), cell_size};
  const std::optional<double> area = projected_area(mesh.rest_positions, mesh.triangles, raster);
  if (!area || *area <= 0) {
    throw InvalidArgument(
        fmt::format("drape: cell_size = {} [m], expected one that fits the specimen: 1 to {} cells",
                    cell_size, kMaxProjectedCells));
  }
  return *area;
}

}  // namespace

Drape measure_drape(const ClothMesh& mesh, ConstMatrix3XRef<double> positions,
                    const DrapeSetup& setup) {
  if (positions.cols() != mesh.num_nodes()) {
    throw InvalidArgument(fmt::format("drape: positions = {} nodes, expected {}", positions.cols(),
                                      mesh.num_nodes()));
  }
  const Vector3<double> normal = area_vector(mesh);
  if (!(normal.norm() > 0)) {
    throw InvalidArgument("drape: rest area = 0 [m^2], expected an open mesh with triangles");
  }
  Drape drape;
  drape.cell_size = setup.cell_size.value_or(cusick_cell_size(normal.norm()));
  const ProjectionRaster raster{setup.up, setup.support_center, drape.cell_size};
  drape.support_area = setup.support_radius ? disc_area(*setup.support_radius, raster) : 0.0;
  drape.projected_area = projected_area(positions, mesh.triangles, raster);
  drape.rest_area = rest_area(mesh, normal, setup, drape.cell_size);
  if (drape.support_area >= drape.rest_area) {
    throw InvalidArgument(
        fmt::format("drape: support area = {} [m^2], expected less than the specimen's {} m^2",
                    drape.support_area, drape.rest_area));
  }
  if (drape.projected_area) {
    drape.area_ratio = *drape.projected_area / drape.rest_area;
    drape.coefficient =
        (*drape.projected_area - drape.support_area) / (drape.rest_area - drape.support_area);
  }
  return drape;
}

}  // namespace weft::validation
