#include <weft/engines/engine_table.hpp>

#include <vector>

#include <weft/engines/reference_simulator.hpp>
#include <weft/scenes/engine_kind.hpp>

#ifdef WEFT_WITH_BULLET
#include <weft/engines/bullet/bullet_deformable_simulator.hpp>
#include <weft/engines/bullet/bullet_simulator.hpp>
#endif

namespace weft::scenes {

std::span<const EngineInfo> engine_table() {
  const auto row = [](const EngineKind& kind, StoredPrecision precision,
                      std::unique_ptr<Simulator> (*make)()) {
    return EngineInfo{kind.name, precision, kind.summary, make};
  };
  static const std::vector<EngineInfo> kEngines = {
#ifdef WEFT_WITH_BULLET
      row(kBulletSoft, bullet_precision(), &make_bullet_soft),
      row(kBulletForces, bullet_precision(), &make_bullet_forces),
      row(kBulletWeft, bullet_precision(), &make_bullet_weft),
      row(kBulletDeformable, bullet_precision(), &make_bullet_deformable),
      row(kBulletDeformableImplicit, bullet_precision(), &make_bullet_deformable_implicit),
#endif
      row(kReferenceEngine, StoredPrecision::kFloat64, &make_reference),
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
