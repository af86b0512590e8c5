#pragma once

// Tested by tests/scenes/engine_kind_test.cpp.

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace weft::scenes {

/// An engine as scenes, commands, messages and pages know it. A program contains some of them (engines/engine_table.hpp).
struct EngineKind {
  std::string_view name;       ///< "bullet_forces"
  std::string_view summary;    ///< one sentence
  bool uses_bullet = true;     ///< there is one for each of Bullet's precisions
  bool has_links = false;      ///< Bullet's links stand for springs
  bool is_implicit = false;    ///< springs are solved for, at any time step
  bool is_deformable = false;  ///< in Bullet's deformable world
};

inline constexpr EngineKind kBulletSoft{
    .name = "bullet_soft",
    .summary = "Bullet's own links, stiffness mapped from N/m; Weft's other laws",
    .has_links = true};
inline constexpr EngineKind kBulletForces{
    .name = "bullet_forces",
    .summary = "Weft's laws in Bullet's world, no links: the equations of the reference"};
inline constexpr EngineKind kBulletWeft{
    .name = "bullet_weft",
    .summary = "Weft's fast solver in Bullet's world: springs implicit, any time step",
    .is_implicit = true};
inline constexpr EngineKind kBulletDeformable{
    .name = "bullet_deformable",
    .summary = "Weft's laws in Bullet's deformable world: forces explicit, dampers implicit",
    .is_deformable = true};
inline constexpr EngineKind kBulletDeformableImplicit{
    .name = "bullet_deformable_implicit",
    .summary = "Weft's laws in Bullet's deformable world, all of them implicit",
    .is_deformable = true};
inline constexpr EngineKind kReferenceEngine{
    .name = "reference",
    .summary = "Weft's own spring solver, double precision, no Bullet",
    .uses_bullet = false};

/// The one list of engines, in the order in which they are shown. The scene format, options of commands, messages and the
/// Python package are made from it; a test holds the pages against it.
inline constexpr std::array<EngineKind, 6> kEngineKinds = {
    kBulletSoft,     kBulletForces, kBulletWeft, kBulletDeformable, kBulletDeformableImplicit,
    kReferenceEngine};

/// The kind of this name, or nullptr.
[[nodiscard]] constexpr const EngineKind* find_engine_kind(std::string_view name) {
  for (const EngineKind& kind : kEngineKinds) {
    if (kind.name == name) return &kind;
  }
  return nullptr;
}

/// Names of the engines for which wanted(kind) holds.
template <class Wanted>
[[nodiscard]] std::vector<std::string> engine_names(Wanted wanted) {
  std::vector<std::string> names;
  for (const EngineKind& kind : kEngineKinds) {
    if (wanted(kind)) names.emplace_back(kind.name);
  }
  return names;
}
[[nodiscard]] inline std::vector<std::string> engine_names() {
  return engine_names([](const EngineKind& /*kind*/) { return true; });
}

}  // namespace weft::scenes
