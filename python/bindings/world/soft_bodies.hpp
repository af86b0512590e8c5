#pragma once

// Tested by tests/python/test_world.py, tests/python/test_tearing.py, tests/python/test_adoption.py.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <weft/bridge/fast_settings.hpp>
#include <weft/bridge/solver.hpp>
#include <weft/python/bindings/records.hpp>

namespace weft::python {

/// What a cloth is made of, beside its mesh.
struct ClothOptions {
  std::vector<forces::LawSpecification> laws = {};
  double margin = 0.01;   ///< [m]
  double friction = 0.5;  ///< [-]
  bool is_implicit = true;
  bridge::FastSettings fast = {};
  bool meets_itself = false;
  bool meets_cloths = false;
  std::optional<double> thickness = std::nullopt;  ///< [m] that layers keep; none: twice margin
  std::optional<TearRule> tear = std::nullopt;
  bool can_be_cut = false;
};

/// Makes a cloth, which is in no world yet. Throws InvalidArgument as make_cloth_body(), for a rule of tears that does not fit
/// the mesh, and for laws that Weft refuses.
[[nodiscard]] std::shared_ptr<ClothRecord> make_cloth(btSoftBodyWorldInfo& info,
                                                      const std::string& name, ClothMesh mesh,
                                                      const ClothOptions& options);
/// Gives it its laws and contacts, when it is in its world. Throws likewise, and then it has none.
void attach_laws(bridge::SoftBodySolver& solver, ClothRecord& cloth, const ClothOptions& options);

/// A body as PyBullet's loadSoftBody makes it of a mesh, by Bullet's own calls.
struct BulletBodyOptions {
  double mass = 1.0;         ///< [kg]
  double link_factor = 1.0;  ///< kLST [-] of the links along edges
  std::optional<double> bending_factor =
      {};                     ///< kLST [-] of links over an edge; none: no such links
  int iterations = 10;        ///< piterations: with it kLST has a stiffness
  double margin = 0.01;       ///< [m]
  double friction = 0.5;      ///< kDF [-]
  double damping = 0.0;       ///< kDP [-]
  bool meets_cloths = false;  ///< VF_SS
  std::vector<int> pins = {};
};

/// Makes such a body and adopts it. vertices [m], each of which belongs to a triangle. Throws InvalidArgument for values out of
/// their domain, and with Weft's reason if the body cannot be adopted.
[[nodiscard]] std::shared_ptr<ClothRecord> make_adopted(
    bridge::SoftBodySolver& solver, btSoftBodyWorldInfo& info, const std::string& name,
    const Matrix3X<double>& vertices, const Triangles& triangles, const BulletBodyOptions& options,
    const bridge::AdoptionSettings& settings);

}  // namespace weft::python
