#include "bench/bullet/demo_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBodyHelpers.h>

namespace weft::bench {
namespace {

/// A closed surface over two angles, point(u, v) with u and v from 0 to 2 pi.
template <class Point>
btSoftBody* closed_surface(DemoWorld& world, int num_u, int num_v, const Point& point) {
  std::vector<btScalar> places;
  std::vector<int> triangles;
  for (int i = 0; i < num_u; ++i) {
    for (int j = 0; j < num_v; ++j) {
      const btVector3 p = point(2 * 3.14159265358979 * i / num_u, 2 * 3.14159265358979 * j / num_v);
      places.insert(places.end(), {p.x(), p.y(), p.z()});
      const int right = (i + 1) % num_u * num_v;
      const int up = (j + 1) % num_v;
      const int here = i * num_v;
      triangles.insert(triangles.end(),
                       {here + j, right + j, right + up, here + j, right + up, here + up});
    }
  }
  return btSoftBodyHelpers::CreateFromTriMesh(world.info(), places.data(), triangles.data(),
                                              static_cast<int>(triangles.size()) / 3);
}

}  // namespace

void bend(btSoftBody& body, double stiffness) {
  btSoftBody::Material* const material = body.appendMaterial();
  material->m_kLST = btScalar(stiffness);
  body.generateBendingConstraints(2, material);
}

btSoftBody* torus(DemoWorld& world) {
  return closed_surface(world, 24, 10, [](double u, double v) {
    const double radius = 2 + 0.8 * std::cos(v);
    return vector(radius * std::cos(u), 0.8 * std::sin(v), radius * std::sin(u));
  });
}

btSoftBody* animal(DemoWorld& world, double size) {
  btSoftBody* const body = btSoftBodyHelpers::CreateEllipsoid(world.info(), vector(0, 0, 0),
                                                              vector(size, size, size), 450);
  for (int i = 0; i < body->m_nodes.size(); ++i) {
    btVector3& x = body->m_nodes[i].m_x;
    const btVector3 out = x / btScalar(size);
    const double ears = std::max(0.0, static_cast<double>(out.y()) - 0.7) *
                        std::abs(static_cast<double>(out.x())) * 3;
    const double bumps = 0.15 * std::sin(5 * static_cast<double>(out.z()));
    x *= btScalar(1 + ears + bumps);
    body->m_nodes[i].m_q = x;
  }
  body->updateConstants();
  bend(*body, 0.5);
  body->m_cfg.piterations = 2;
  body->m_cfg.kDF = btScalar(0.5);
  return body;
}

/// A cube of n^3 cells of six tetrahedra each, as text in TetGen's format.
btSoftBody* tetrahedral_cube(DemoWorld& world, int n, double size) {
  const auto node = [&](int x, int y, int z) { return (x * (n + 1) + y) * (n + 1) + z; };
  std::string nodes = std::to_string((n + 1) * (n + 1) * (n + 1)) + " 3 0 0\n";
  for (int x = 0; x <= n; ++x) {
    for (int y = 0; y <= n; ++y) {
      for (int z = 0; z <= n; ++z) {
        nodes += std::to_string(node(x, y, z)) + " " + std::to_string(size * x / n) + " " +
                 std::to_string(size * y / n) + " " + std::to_string(size * z / n) + "\n";
      }
    }
  }
  // The tetrahedra share the diagonal from (0, 0, 0) to (1, 1, 1): there is one for each order of the axes.
  constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  std::string elements = std::to_string(6 * n * n * n) + " 4 0\n";
  int number = 0;
  for (int cell = 0; cell < n * n * n; ++cell) {
    for (const auto& order : kOrders) {
      int at[3] = {cell / (n * n), cell / n % n, cell % n};
      elements += std::to_string(number++) + " " + std::to_string(node(at[0], at[1], at[2]));
      for (const int axis : order) {
        ++at[axis];
        elements += " " + std::to_string(node(at[0], at[1], at[2]));
      }
      elements += "\n";
    }
  }
  return btSoftBodyHelpers::CreateFromTetGenData(world.info(), elements.c_str(), nullptr,
                                                 nodes.c_str(), false, true, true);
}

}  // namespace weft::bench
