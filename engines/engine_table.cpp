#include <weft/engines/engine_table.hpp>

#include <vector>

#include <weft/engines/reference_simulator.hpp>

#ifdef WEFT_WITH_BULLET
#include <weft/engines/bullet/bullet_deformable_simulator.hpp>
#include <weft/engines/bullet/bullet_simulator.hpp>
#endif

namespace weft::scenes {

std::span<const EngineInfo> engine_table() {
  static const std::vector<EngineInfo> kEngines = {
#ifdef WEFT_WITH_BULLET
      {"bullet_soft", bullet_precision(),
       "Bullet's own links, stiffness mapped from N/m; Weft's other laws", &make_bullet_soft},
      {"bullet_forces", bullet_precision(),
       "Weft's laws in Bullet's world, no links: the equations of the reference",
       &make_bullet_forces},
      {"bullet_weft", bullet_precision(),
       "Weft's fast solver in Bullet's world: springs implicit, any time step", &make_bullet_weft},
      {"bullet_deformable", bullet_precision(),
       "Weft's laws in Bullet's deformable world: forces explicit, dampers implicit",
       &make_bullet_deformable},
      {"bullet_deformable_implicit", bullet_precision(),
       "Weft's laws in Bullet's deformable world, all of them implicit",
       &make_bullet_deformable_implicit},
#endif
      {"reference", StoredPrecision::kFloat64,
       "Weft's own spring solver, double precision, no Bullet", &make_reference},
  };
  return kEngines;
}

const EngineInfo* find_engine(std::string_view name, StoredPrecision precision) {
  for (const EngineInfo& engine : engine_table()) {
    if (engine.name == name && engine.precision == precision) return &engine;
  }
  return nullptr;
}

std::string bullet_description() {
#ifdef WEFT_WITH_BULLET
  return bullet_version_text();
#else
  return "none";
#endif
}

}  // namespace weft::scenes
