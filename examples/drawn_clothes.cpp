// Clothes: what is drawn has two layers, a hem and a button, 9,600 triangles; what is simulated are the 225 nodes below them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include <weft/weft.hpp>

#include <btBulletDynamicsCommon.h>

namespace {

constexpr int kSide = 49;                 // drawn vertices along an edge
constexpr double kHalfThickness = 0.003;  // [m]

/// Two layers around a plane of 0.8 m x 0.8 m, joined along the border, and a flat button of 3 cm on the upper one.
weft::DrawnMesh tailor() {
  weft::DrawnMesh drawn;
  const int layer = kSide * kSide;
  drawn.positions.resize(3, 2 * layer + 5);
  for (int v = 0; v < layer; ++v) {
    const double x = 0.8 * (v % kSide) / (kSide - 1) - 0.4;
    const double z = 0.4 - 0.8 * (v / kSide) / (kSide - 1);
    drawn.positions.col(v) << x, 1 + kHalfThickness, z;
    drawn.positions.col(layer + v) << x, 1 - kHalfThickness, z;
  }
  std::vector<int> corners;
  for (int j = 0; j + 1 < kSide; ++j) {
    for (int i = 0; i + 1 < kSide; ++i) {
      const int a = j * kSide + i;
      const int d = a + kSide;
      corners.insert(corners.end(), {a, a + 1, d + 1, a, d + 1, d});
      corners.insert(corners.end(), {layer + a, layer + d + 1, layer + a + 1});
      corners.insert(corners.end(), {layer + a, layer + d, layer + d + 1});
    }
  }
  for (int i = 0; i + 1 < kSide; ++i) {  // the four sides of the border
    const int far = kSide * (kSide - 1);
    for (const auto& [a, b] : {std::pair(i + 1, i), std::pair(far + i, far + i + 1),
                               std::pair(kSide * i, kSide * (i + 1)),
                               std::pair(kSide * (i + 1) + kSide - 1, kSide * i + kSide - 1)}) {
      corners.insert(corners.end(), {a, b, layer + b, a, layer + b, layer + a});
    }
  }
  const int button = 2 * layer;
  for (int k = 0; k < 4; ++k) {
    const double angle = 1.5707963267948966 * k;
    drawn.positions.col(button + k) << 0.2 + 0.015 * std::cos(angle), 1.008,
        0.015 * std::sin(angle);
    corners.insert(corners.end(), {button + 4, button + (k + 1) % 4, button + k});
  }
  drawn.positions.col(button + 4) << 0.2, 1.008, 0;
  drawn.triangles = Eigen::Map<const weft::Triangles>(corners.data(), 3, std::ssize(corners) / 3);
  return drawn;
}

}  // namespace

int main() {
  weft::bridge::SoftWorld world({});
  auto ball = std::make_shared<btSphereShape>(btScalar(0.25));
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, ball.get());
  info.m_startWorldTransform.setOrigin(btVector3(0, btScalar(0.7), 0));
  world.add(std::make_unique<btRigidBody>(info), ball);

  const weft::ClothMesh mesh = weft::make_cloth_grid(
      {.nodes = {15, 15}, .size = {0.8, 0.8}, .center = {0, 1, 0}, .total_mass = 0.2});
  btSoftBody& body =
      world.add(weft::bridge::make_cloth_body(world.info(), mesh, {.collision_margin = 0.01}));
  const auto refusal =
      world.solver().attach_fast(body, mesh,
                                 {weft::laws::tension({.stiffness = 500.0}),
                                  weft::laws::gravity({.acceleration = {0, -9.81, 0}})});
  if (refusal) return std::fprintf(stderr, "%s\n", refusal->c_str()), 2;

  // Once: the drawn mesh lies around the cloth at rest. A vertex that is forgotten somewhere else is an error.
  const weft::DrawnMesh drawn = tailor();
  weft::bridge::DrawnBody clothes(mesh, drawn, {.max_distance = 0.02, .rigid_pieces = 0.05});
  const auto num_vertices = static_cast<std::size_t>(clothes.embedding().num_vertices());
  struct Vertex {
    float position[3];
    float normal[3];
  };
  std::vector<Vertex> vertices(num_vertices);  // or a mapped buffer of the graphics card

  const std::size_t layer = std::size_t{kSide} * kSide;
  double thinnest = 1;
  double thickest = 0;
  int num_turned = 0;  // places where the layers have changed sides
  for (int frame = 0; frame < 120; ++frame) {
    world.step(1 / 60.0);
    clothes.update(body);
    clothes.write({vertices[0].position, vertices[0].normal, nullptr, sizeof(Vertex)});
    for (std::size_t v = 0; v < layer; ++v) {  // from the lower layer to the upper one
      double height = 0;
      double square = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const double step = static_cast<double>(vertices[v].position[i]) -
                            static_cast<double>(vertices[layer + v].position[i]);
        height += static_cast<double>(vertices[v].normal[i]) * step;
        square += step * step;
      }
      if (height <= 0) ++num_turned;
      thinnest = std::min(thinnest, std::sqrt(square));
      thickest = std::max(thickest, std::sqrt(square));
    }
  }
  const float* rim = vertices[2 * layer].position;
  const float* middle = vertices[2 * layer + 4].position;
  const double radius =
      std::hypot(static_cast<double>(rim[0] - middle[0]), static_cast<double>(rim[1] - middle[1]),
                 static_cast<double>(rim[2] - middle[2]));
  const double drop = 1 - static_cast<double>(vertices[0].position[1]);
  std::printf("%td triangles on %d nodes; the corner hangs %.2f m lower\n", drawn.triangles.cols(),
              mesh.num_nodes(), drop);
  std::printf("thickness %.5f to %.5f m, turned over at %d places, button of radius %.7f m\n",
              thinnest, thickest, num_turned, radius);
  const bool is_right = drop > 0.2 && num_turned == 0 && thinnest > 1.9 * kHalfThickness &&
                        thickest < 2.1 * kHalfThickness && std::abs(radius - 0.015) < 1e-6 &&
                        clothes.embedding().report().num_rigid_pieces == 1;
  return is_right ? 0 : 1;
}
