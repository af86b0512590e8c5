#include <weft/mesh/surface_body.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <weft/core/error.hpp>
#include <weft/mesh/topology/hinges.hpp>

namespace weft {
namespace {

void require_surface(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("surface body: " + message);
}

double triangle_area(const Surface& surface, Eigen::Index t) {
  const Vector3<double> a = surface.positions.col(surface.triangles(0, t));
  const Vector3<double> b = surface.positions.col(surface.triangles(1, t));
  const Vector3<double> c = surface.positions.col(surface.triangles(2, t));
  return 0.5 * (b - a).cross(c - a).norm();
}

void check_texture(const Matrix2X<double>& coordinates, Eigen::Index expected,
                   const std::string& what) {
  if (coordinates.cols() == 0) return;
  require_surface(coordinates.cols() == expected,
                  std::to_string(coordinates.cols()) + " texture coordinates of " + what +
                      ", expected " + std::to_string(expected) + " or none");
  require_surface(coordinates.allFinite(),
                  "a texture coordinate of the " + what + " is not finite");
}

void check_triangle(const Surface& surface, Eigen::Index t) {
  const std::string name = "triangle " + std::to_string(t);
  const Eigen::Index num_nodes = surface.positions.cols();
  const Eigen::Vector3i corners = surface.triangles.col(t);
  for (const int node : corners) {
    require_surface(node >= 0 && node < num_nodes, name + " names node " + std::to_string(node) +
                                                       ", expected 0 to " +
                                                       std::to_string(num_nodes - 1));
  }
  require_surface(corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0],
                  name + " names a node twice, expected three nodes");
  const double area = triangle_area(surface, t);
  require_surface(
      area > 0 && std::isfinite(area),
      name + " has an area of " + std::to_string(area) + " [m^2], expected > 0 and finite");
}

void check(const Surface& surface) {
  require_surface(surface.triangles.cols() > 0, "no triangle, expected at least one");
  const Eigen::Index num_nodes = surface.positions.cols();
  for (Eigen::Index n = 0; n < num_nodes; ++n) {
    require_surface(surface.positions.col(n).allFinite(),
                    "the position of node " + std::to_string(n) + " is not finite");
  }
  std::vector<bool> is_used(static_cast<std::size_t>(num_nodes), false);
  for (Eigen::Index t = 0; t < surface.triangles.cols(); ++t) {
    check_triangle(surface, t);
    for (const int node : surface.triangles.col(t)) is_used[static_cast<std::size_t>(node)] = true;
  }
  const auto unused = std::find(is_used.begin(), is_used.end(), false);
  require_surface(unused == is_used.end(),
                  "node " + std::to_string(unused - is_used.begin()) +
                      " belongs to no triangle, expected one around each node");
  check_texture(surface.texture_coordinates, num_nodes, "nodes");
  check_texture(surface.corner_texture_coordinates, surface.triangles.size(), "corners");
}

void check(const BodyMass& mass) {
  require_surface(
      std::isfinite(mass.total_mass) && mass.total_mass > 0,
      "total_mass = " + std::to_string(mass.total_mass) + " [kg], expected > 0 and finite");
  if (!mass.center_mass_share) return;
  require_surface(*mass.center_mass_share > 0 && *mass.center_mass_share < 1,
                  "center_mass_share = " + std::to_string(*mass.center_mass_share) +
                      " [1], expected > 0 and < 1");
}

/// The far corners of each hinge, each pair once and none that an edge ties already.
Edges bend_edges(const Edges& stretch, const Hinges& hinges) {
  std::set<std::pair<int, int>> taken;
  for (Eigen::Index e = 0; e < stretch.cols(); ++e) taken.emplace(stretch(0, e), stretch(1, e));
  std::vector<int> flat;
  for (Eigen::Index h = 0; h < hinges.cols(); ++h) {
    const auto [first, second] = std::minmax(hinges(2, h), hinges(3, h));
    if (first == second || !taken.emplace(first, second).second) continue;
    flat.push_back(first);
    flat.push_back(second);
  }
  return Eigen::Map<const Edges>(flat.data(), 2, static_cast<Eigen::Index>(flat.size() / 2));
}

Vector3<double> centroid(const Surface& surface) {
  // Relative to a node: far from the origin the sum would lose digits.
  const Vector3<double> from = surface.positions.col(0);
  Vector3<double> moment = Vector3<double>::Zero();
  for (Eigen::Index t = 0; t < surface.triangles.cols(); ++t) {
    const auto corners = surface.positions(Eigen::all, surface.triangles.col(t));
    moment += triangle_area(surface, t) * (corners.rowwise().mean() - from);
  }
  return from + moment / surface_area(surface);
}

void add_center(const Surface& surface, ClothMesh& mesh) {
  const int center = mesh.num_nodes();
  const Vector3<double> position = centroid(surface);
  Edges spokes(2, center);
  for (int node = 0; node < center; ++node) {
    spokes.col(node) << node, center;
    require_surface((surface.positions.col(node) - position).norm() > 0,
                    "the centre node falls on node " + std::to_string(node) +
                        ", expected a surface around its centroid");
  }
  mesh.rest_positions.conservativeResize(3, center + 1);
  mesh.rest_positions.col(center) = position;
  if (mesh.texture_coordinates.cols() > 0) {
    mesh.texture_coordinates.conservativeResize(2, center + 1);
    mesh.texture_coordinates.col(center).setConstant(0.5);  // of no triangle: never drawn
  }
  mesh.edge_sets.push_back({"center", spokes});
  mesh.connection_sets.push_back({"center", spokes});
}

}  // namespace

ClothMesh make_surface_body(const Surface& surface, const BodyMass& mass) {
  check(mass);
  check(surface);
  ClothMesh mesh;
  mesh.rest_positions = surface.positions;
  mesh.triangles = surface.triangles;
  mesh.texture_coordinates = surface.texture_coordinates;
  mesh.corner_texture_coordinates = surface.corner_texture_coordinates;
  Edges stretch = edges_of_triangles(mesh.triangles);
  Edges bend = bend_edges(stretch, hinges_of_triangles(mesh.triangles));
  mesh.edge_sets.push_back({"stretch", std::move(stretch)});
  mesh.edge_sets.push_back({"bend", std::move(bend)});
  mesh.masses = mass.lumping == MassLumping::kArea ? node_areas(mesh)
                                                   : VectorX<double>::Ones(mesh.num_nodes());
  const double center_mass = mass.center_mass_share.value_or(0.0) * mass.total_mass;
  mesh.masses *= (mass.total_mass - center_mass) / mesh.masses.sum();
  if (mass.center_mass_share) {
    add_center(surface, mesh);
    mesh.masses.conservativeResize(mesh.num_nodes());
    mesh.masses[mesh.num_nodes() - 1] = center_mass;
  }
  return mesh;
}

double surface_area(const Surface& surface) {
  double area = 0;
  for (Eigen::Index t = 0; t < surface.triangles.cols(); ++t) area += triangle_area(surface, t);
  return area;
}

}  // namespace weft
