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

void BulletTears::serialize(StateArchive& archive, bridge::SoftBodySolver& solver,
                            BulletBodies& bodies) {
  archive.part("tears");
  for (Entry& entry : entries_) {
    const TornCloth loaded = entry.torn;
    entry.torn.serialize(archive);
    if (!archive.is_reading() || entry.torn.topology() == loaded.topology()) continue;
    const Tear tear = entry.torn.tear_since(loaded);
    btSoftBody& body = *bodies.cloths()[entry.cloth];
    if (tear.any()) {
      bridge::apply_tear(tear, entry.settings, body);
      solver.add_copies(body, tear.origins);
    }
    bodies.set_torn(entry.cloth, entry.torn.mesh(), entry.torn.topology());
  }
  if (archive.is_reading()) renew_laws(solver, bodies);
}

void BulletTears::renew_laws(bridge::SoftBodySolver& solver, const BulletBodies& bodies) const {
  for (const Entry& entry : entries_) {
    if (!entry.torn.topology()) continue;
    solver.replace_laws(*bodies.cloths()[entry.cloth], entry.torn.mesh(), entry.laws);
  }
}

}  // namespace weft::scenes
