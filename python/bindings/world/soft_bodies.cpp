#include <weft/python/bindings/world/soft_bodies.hpp>

#include <cmath>
#include <utility>

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <fmt/format.h>

#include <weft/core/error.hpp>

namespace weft::python {
namespace {

/// Moves the nodes of a body that nobody knows yet to where there is room for so many. Nodes of a cloth that tears never move
/// again then, so that NumPy may show them as they are.
void reserve_nodes(btSoftBody& body, int capacity) {
  const btSoftBody::Node* const before = &body.m_nodes[0];
  body.m_nodes.reserve(capacity);
  btSoftBody::Node* const now = &body.m_nodes[0];
  for (int i = 0; i < body.m_nodes.size(); ++i) now[i].m_leaf->data = &now[i];
  for (int f = 0; f < body.m_faces.size(); ++f) {
    for (btSoftBody::Node*& corner : body.m_faces[f].m_n) corner = now + (corner - before);
  }
  for (int l = 0; l < body.m_links.size(); ++l) {
    for (btSoftBody::Node*& end : body.m_links[l].m_n) end = now + (end - before);
  }
}

/// The largest number of nodes that cuts make of a mesh: each new node has a triangle of its own.
int most_nodes(const ClothMesh& mesh) {
  return mesh.num_nodes() + 3 * static_cast<int>(mesh.triangles.cols());
}

void require(bool is_good, const char* name, double value, const char* unit, const char* expected) {
  if (is_good) return;
  throw InvalidArgument(
      fmt::format("adopt: {} = {} [{}], expected {}", name, value, unit, expected));
}

bool is_share(double value) {
  return value >= 0 && value <= 1;
}

void check(const BulletBodyOptions& options) {
  const auto is_not_negative = [](double value) { return value >= 0 && std::isfinite(value); };
  require(options.mass > 0 && std::isfinite(options.mass), "mass", options.mass, "kg",
          "> 0 and finite");
  require(is_share(options.link_factor), "link_factor", options.link_factor, "1", "0 to 1");
  if (options.bending_factor) {
    require(is_share(*options.bending_factor), "bending_factor", *options.bending_factor, "1",
            "0 to 1");
  }
  require(options.iterations >= 1, "iterations", options.iterations, "1", ">= 1");
  require(is_not_negative(options.margin), "margin", options.margin, "m", ">= 0 and finite");
  require(is_not_negative(options.friction), "friction", options.friction, "1", ">= 0 and finite");
  require(is_share(options.damping), "damping", options.damping, "1", "0 to 1");
}

std::unique_ptr<btSoftBody> make_bullet_body(btSoftBodyWorldInfo& info,
                                             const Matrix3X<double>& vertices,
                                             const Triangles& triangles,
                                             const BulletBodyOptions& options) {
  const Matrix3X<btScalar> positions = vertices.cast<btScalar>();
  std::unique_ptr<btSoftBody> body(btSoftBodyHelpers::CreateFromTriMesh(
      info, positions.data(), triangles.data(), static_cast<int>(triangles.cols()), false));
  body->m_materials[0]->m_kLST = static_cast<btScalar>(options.link_factor);
  if (options.bending_factor) {
    btSoftBody::Material* const bending = body->appendMaterial();
    bending->m_kLST = static_cast<btScalar>(*options.bending_factor);
    body->generateBendingConstraints(2, bending);
  }
  body->m_cfg.piterations = options.iterations;
  body->m_cfg.kDF = static_cast<btScalar>(options.friction);
  body->m_cfg.kDP = static_cast<btScalar>(options.damping);
  if (options.meets_cloths) body->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
  body->getCollisionShape()->setMargin(static_cast<btScalar>(options.margin));
  body->setTotalMass(static_cast<btScalar>(options.mass), true);
  for (const int pin : options.pins) body->setMass(pin, 0);
  return body;
}

/// Bullet makes a node of each index up to the largest one.
void check_vertices(const Matrix3X<double>& vertices, const Triangles& triangles) {
  std::vector<bool> is_used(static_cast<std::size_t>(vertices.cols()), false);
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (const int node : triangles.col(t)) is_used[static_cast<std::size_t>(node)] = true;
  }
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (!is_used[i]) {
      throw InvalidArgument(fmt::format(
          "adopt: vertex {} belongs to no triangle, expected each to belong to one", i));
    }
  }
  if (is_used.empty()) throw InvalidArgument("adopt: there is no vertex, expected some");
}

}  // namespace

std::shared_ptr<ClothRecord> make_cloth(btSoftBodyWorldInfo& info, const std::string& name,
                                        ClothMesh mesh, const ClothOptions& options) {
  auto cloth = std::make_shared<ClothRecord>();
  cloth->name = name;
  cloth->settings = {.collision_margin = options.margin, .friction = options.friction};
  cloth->laws = options.laws;
  cloth->tear_rule = options.tear;
  cloth->can_be_cut = options.can_be_cut || options.tear;
  cloth->body = bridge::make_cloth_body(info, mesh, cloth->settings);
  if (options.tear) check(*options.tear, mesh);
  if (cloth->can_be_cut) reserve_nodes(*cloth->body, most_nodes(mesh));
  cloth->mesh = std::move(mesh);
  return cloth;
}

void attach_laws(bridge::SoftBodySolver& solver, ClothRecord& cloth, const ClothOptions& options) {
  btSoftBody& body = *cloth.body;
  if (options.meets_itself || options.meets_cloths) {
    solver.set_cloth_contact(
        body, {.with_itself = options.meets_itself,
               .with_others = options.meets_cloths,
               .self_thickness = options.thickness.value_or(2 * options.margin),
               .margin = options.margin > 0 ? options.margin : 0.5 * options.thickness.value_or(0),
               .friction = options.friction});
  }
  if (options.is_implicit) {
    if (const auto reason = solver.attach_fast(body, *cloth.mesh, options.laws, options.fast)) {
      throw InvalidArgument("cloth '" + cloth.name + "': cannot be stepped implicitly: " + *reason);
    }
  } else {
    solver.attach(body, *cloth.mesh, options.laws);
  }
  cloth.handle = solver.cloth(body);
}

std::shared_ptr<ClothRecord> make_adopted(bridge::SoftBodySolver& solver, btSoftBodyWorldInfo& info,
                                          const std::string& name, const Matrix3X<double>& vertices,
                                          const Triangles& triangles,
                                          const BulletBodyOptions& options,
                                          const bridge::AdoptionSettings& settings) {
  check(options);
  check_vertices(vertices, triangles);
  auto cloth = std::make_shared<ClothRecord>();
  cloth->name = name;
  cloth->body = make_bullet_body(info, vertices, triangles, options);
  bridge::AdoptionReport report = bridge::adopt(solver, *cloth->body, settings);
  if (report.refusal) throw InvalidArgument("adopt: cloth '" + name + "': " + *report.refusal);
  cloth->adopted = std::move(report.properties);
  cloth->handle = std::move(report.cloth);
  cloth->laws = cloth->handle.laws();
  return cloth;
}

}  // namespace weft::python
