// With nothing attached, Weft's solver is Bullet's default solver, bit for bit.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include <weft/bridge/solver.hpp>
#include <weft/custom_forces/registry.hpp>

#include "tests/bridge/bullet_scenes.hpp"

namespace weft::bridge::testing {
namespace {

constexpr int kNumSteps = 300;

class BitIdentity : public ::testing::TestWithParam<int> {
 protected:
  [[nodiscard]] static const BulletScene& scene() {
    return bullet_scenes()[static_cast<std::size_t>(GetParam())];
  }
};

bool same_bits(const std::vector<btScalar>& a, const std::vector<btScalar>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(btScalar)) == 0;
}

bool all_finite(const std::vector<btScalar>& values) {
  for (const btScalar value : values) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

TEST_P(BitIdentity, SolverWithoutLawsLeavesBulletUnchanged) {
  const std::vector<btScalar> bullet = run_scene(scene(), nullptr, kNumSteps);
  SoftBodySolver solver;
  const std::vector<btScalar> weft = run_scene(scene(), &solver, kNumSteps);
  EXPECT_TRUE(all_finite(bullet))
      << "the scene itself must be sound for the comparison to mean something";
  EXPECT_TRUE(same_bits(bullet, weft));
}

// The comparison can fail: a solver that touches one body's velocity by one unit in the last place
// is noticed.
class OneBitOff final : public SoftBodySolver {
 public:
  void solveConstraints(btScalar time_step) override {
    SoftBodySolver::solveConstraints(time_step);
    btScalar& v = m_softBodySet[0]->m_nodes[m_softBodySet[0]->m_nodes.size() / 2].m_v[1];
    v = std::nextafter(v, btScalar(1e9));
  }
};

TEST_P(BitIdentity, OneBitOffIsNoticed) {
  const std::vector<btScalar> bullet = run_scene(scene(), nullptr, 3);
  OneBitOff solver;
  EXPECT_FALSE(same_bits(bullet, run_scene(scene(), &solver, 3)));
}

INSTANTIATE_TEST_SUITE_P(Scenes, BitIdentity,
                         ::testing::Range(0, static_cast<int>(bullet_scenes().size())),
                         [](const ::testing::TestParamInfo<int>& info) {
                           return bullet_scenes()[static_cast<std::size_t>(info.param)].name;
                         });

}  // namespace
}  // namespace weft::bridge::testing
