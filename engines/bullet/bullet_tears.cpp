#include <weft/engines/bullet/bullet_tears.hpp>

#include <utility>

#include <weft/bridge/tearing.hpp>

namespace weft::scenes {

void BulletTears::add(std::size_t cloth, const ClothTear& tear, const ClothMesh& mesh,
                      bridge::ClothSettings settings, std::vector<forces::LawSpecification> laws) {
  entries_.push_back({cloth, TornCloth(mesh, tear), std::move(settings), std::move(laws)});
}

void BulletTears::apply(const Tear& tear, Entry& entry, bridge::SoftBodySolver& solver,
                        BulletBodies& bodies) {
  btSoftBody& body = *bodies.cloths()[entry.cloth];
  bridge::apply_tear(tear, entry.settings, entry.laws, solver, body);
  entry.torn.adopt(tear);
  bodies.set_torn(entry.cloth, entry.torn.mesh(), entry.torn.topology());
}

void BulletTears::make_first_cuts(bridge::SoftBodySolver& solver, BulletBodies& bodies) {
  for (Entry& entry : entries_) {
    if (const auto tear = entry.torn.first_cuts()) apply(*tear, entry, solver, bodies);
  }
}

bool BulletTears::tear(bridge::SoftBodySolver& solver, BulletBodies& bodies) {
  bool any = false;
  for (Entry& entry : entries_) {
    const auto tear = entry.torn.tear_at(bodies.state().cloths[entry.cloth].positions);
    if (!tear) continue;
    apply(*tear, entry, solver, bodies);
    any = true;
  }
  return any;
}

}  // namespace weft::scenes
