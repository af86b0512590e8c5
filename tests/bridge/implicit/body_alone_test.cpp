// Bodies that are stepped alone, that share their set-up and that repeat steps at rest, against the same bodies in worlds where
// none of this is possible: every change at run time must have the same result, to the bit.
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <weft/bridge/snapshot.hpp>
#include <weft/bridge/tearing.hpp>
#include <weft/core/parallel/threads.hpp>
#include <weft/core/trace.hpp>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

const ClothSettings kSettings{.collision_margin = kMargin, .links = {{{}, 300.0}}};

std::vector<forces::LawSpecification> laws(double stiffness) {
  return {kGravity, law("tension", "stiffness", stiffness), law("hinge_torsion", "rigidity", 1e-4)};
}

/// Equal cloths at the same place on a floor, which do not meet each other.
class Cloths {
 public:
  /// together: a contact with cloth is set for each, which meets none. The bodies then go through each stage together, so that
  /// none of them is alone or repeats a step.
  Cloths(int count, bool together, double height)
      : world_(SoftWorldSettings{}), mesh_(cloth(10, 0.5, height)) {
    for (int k = 0; k < count; ++k) {
      btSoftBody& body = world_.add(make_cloth_body(world_.info(), mesh_, kSettings));
      EXPECT_FALSE(world_.solver().attach_fast(body, mesh_, laws(300), {.may_sleep = false}));
      if (together) world_.solver().set_cloth_contact(body, {.with_others = false});
      bodies_.push_back(&body);
    }
    floor_ = &add_rigid(world_, box(2, 0.5, 2), 0, at(0, -0.5, 0));
  }
  void step() { world_.step(kTimeStep); }
  [[nodiscard]] std::vector<Matrix3X<btScalar>> state_of(std::size_t k) {
    Matrix3X<btScalar> positions;
    Matrix3X<btScalar> velocities;
    read_nodes(*bodies_[k], positions, velocities);
    return {positions, velocities};
  }
  [[nodiscard]] SoftWorld& world() { return world_; }
  [[nodiscard]] SoftBodySolver& solver() { return world_.solver(); }
  [[nodiscard]] btSoftBody& body(std::size_t k) { return *bodies_[k]; }
  [[nodiscard]] btRigidBody& floor() { return *floor_; }
  [[nodiscard]] const ClothMesh& mesh() const { return mesh_; }

 private:
  SoftWorld world_;
  ClothMesh mesh_;
  std::vector<btSoftBody*> bodies_;
  btRigidBody* floor_ = nullptr;
};

/// A change that a program makes at run time to a body, or to its surroundings.
struct Change {
  std::string name;
  std::function<void(Cloths&, btSoftBody&)> make;
};

void tear_in_the_middle(Cloths& one, btSoftBody& body) {
  ClothMesh mesh = one.mesh();
  const Blade blade{{-0.3, 0.01, 0.02}, {0.1, 0.01, 0.02}, {0, 0.1, 0}};
  const Tear torn = cut(one.solver(), body, mesh, kSettings, laws(300), blade);
  EXPECT_GT(torn.mesh.num_nodes(), one.mesh().num_nodes());
}

/// Changes of what one body is made of and where it is, which must not change what others do.
const std::vector<Change>& changes_of_state() {
  static const std::vector<Change> changes = {
      {"nothing", [](Cloths&, btSoftBody&) {}},
      {"velocity", [](Cloths&, btSoftBody& body) { body.m_nodes[3].m_v.setY(btScalar(0.5)); }},
      {"position", [](Cloths&, btSoftBody& body) { body.m_nodes[9].m_x += vector(0, 0.05, 0); }},
      {"force", [](Cloths&, btSoftBody& body) { body.addForce(vector(0, 2, 0), 7); }},
      {"pin", [](Cloths&, btSoftBody& body) { body.setMass(5, 0); }},
      {"pin that is lifted",
       [](Cloths&, btSoftBody& body) {
         body.setMass(0, 0);
         body.m_nodes[0].m_x += vector(0, 0.03, 0);
       }},
      {"mass and push",
       [](Cloths&, btSoftBody& body) {
         body.m_nodes[5].m_im *= btScalar(0.5);
         body.m_nodes[5].m_v.setY(btScalar(0.5));
       }},
      {"rest length", [](Cloths&, btSoftBody& body) { body.m_links[20].m_rl *= btScalar(0.8); }},
      {"scale", [](Cloths&, btSoftBody& body) { body.scale(vector(0.98, 1, 0.98)); }},
  };
  return changes;
}

/// Changes of how one body is stepped, which must not change what others do.
const std::vector<Change>& changes_of_settings() {
  static const std::vector<Change> changes = {
      {"friction and push",
       [](Cloths&, btSoftBody& body) {
         body.m_cfg.kDF = btScalar(0.05);
         body.addVelocity(vector(0.3, 0, 0));
       }},
      {"damping", [](Cloths&, btSoftBody& body) { body.m_cfg.kDP = btScalar(0.1); }},
      {"margin",
       [](Cloths&, btSoftBody& body) { body.getCollisionShape()->setMargin(btScalar(0.02)); }},
      {"collisions", [](Cloths&, btSoftBody& body) { body.m_cfg.collisions = 0; }},
      {"anchor",
       [](Cloths& one, btSoftBody& body) {
         body.appendAnchor(99, &one.floor());
         body.m_anchors[0].m_local += vector(0, 0.04, 0);
       }},
      {"pressure of air",
       [](Cloths&, btSoftBody& body) {
         body.m_cfg.kDG = btScalar(0.1);
         body.m_windVelocity = vector(1, 0, 3);
       }},
      {"stiffness and push",
       [](Cloths& one, btSoftBody& body) {
         one.solver().replace_laws(body, one.mesh(), laws(1200));
         body.m_nodes[9].m_x += vector(0.03, 0.05, 0);
       }},
      {"wind",
       [](Cloths& one, btSoftBody& body) {
         std::vector<forces::LawSpecification> with_drag = laws(300);
         with_drag.push_back({"wind", {}, {{"velocity", {2.0, 3.0, 0.0}}}});
         one.solver().replace_laws(body, one.mesh(), with_drag);
       }},
      {"settings and push",
       [](Cloths& one, btSoftBody& body) {
         one.solver().set_fast_settings(body,
                                        {.solver = {.newton_iterations = 1}, .may_sleep = false});
         body.m_nodes[9].m_v.setY(1);
       }},
      {"limits",
       [](Cloths& one, btSoftBody& body) {
         Matrix3X<btScalar> positions;
         Matrix3X<btScalar> velocities;
         read_nodes(body, positions, velocities);
         PositionLimits limits;
         limits.centers = positions.cast<double>();
         limits.centers.row(1).array() += 0.03;
         limits.max_distances.setConstant(positions.cols(), 0.02);
         one.solver().set_position_limits(body, limits);
       }},
      {"tear and push",
       [](Cloths& one, btSoftBody& body) {
         tear_in_the_middle(one, body);
         body.m_nodes[9].m_v.setY(1);
         body.m_nodes[body.m_nodes.size() - 1].m_v.setY(1);
       }},
      {"suspended and lifted",
       [](Cloths& one, btSoftBody& body) {
         one.solver().set_suspended(body, true);
         one.step();
         one.solver().set_suspended(body, false);
         body.translate(vector(0, 0.02, 0));
       }},
      {"out of the world and back",
       [](Cloths& one, btSoftBody& body) {
         one.world().world().removeSoftBody(&body);
         one.step();
         one.world().world().addSoftBody(&body);
         body.m_nodes[9].m_v.setY(1);
       }},
      {"detached", [](Cloths& one, btSoftBody& body) { one.solver().detach(body); }},
  };
  return changes;
}

std::vector<Change> changes_of_a_body() {
  std::vector<Change> changes = changes_of_state();
  changes.insert(changes.end(), changes_of_settings().begin(), changes_of_settings().end());
  return changes;
}

/// Those that all bodies of the world see.
const std::vector<Change>& changes_of_the_world() {
  static const std::vector<Change> changes = {
      {"floor", [](Cloths& one, btSoftBody&) { one.floor().setWorldTransform(at(0, -0.49, 0)); }},
      {"floor away",
       [](Cloths& one, btSoftBody&) { one.world().world().removeRigidBody(&one.floor()); }},
      {"floor turns",
       [](Cloths& one, btSoftBody&) {
         one.floor().setWorldTransform(
             btTransform(btQuaternion(vector(0, 0, 1), btScalar(0.05)), vector(0, -0.5, 0)));
       }},
      {"floor without response",
       [](Cloths& one, btSoftBody&) {
         one.floor().setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT |
                                       btCollisionObject::CF_NO_CONTACT_RESPONSE);
       }},
      {"floor grows",
       [](Cloths& one, btSoftBody&) {
         one.floor().getCollisionShape()->setLocalScaling(vector(1, 1.02, 1));
       }},
      {"floor moves",
       [](Cloths& one, btSoftBody&) {
         one.floor().setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
         one.floor().setLinearVelocity(vector(0.5, 0, 0));
         one.floor().setInterpolationWorldTransform(at(-0.01, -0.5, 0));
       }},
      {"slippery floor",
       [](Cloths& one, btSoftBody& body) {
         one.floor().setFriction(btScalar(0.01));
         body.addVelocity(vector(0.3, 0, 0));
       }},
      {"collider",
       [](Cloths& one, btSoftBody&) {
         add_rigid(one.world(), std::make_shared<btSphereShape>(btScalar(0.1)), 0,
                   at(0.05, -0.05, 0));
       }},
      {"concave collider beside boxes",
       [](Cloths& one, btSoftBody&) {
         add_rigid(one.world(), std::make_shared<btSphereShape>(btScalar(0.1)), 0,
                   at(0.05, -0.06, 0));
         add_rigid(one.world(), box(0.02, 0.02, 0.02), 0, at(-0.1, 0.01, 0.1));
       }},
      {"gravity", [](Cloths& one, btSoftBody&) { one.world().info().m_gravity = vector(2, 0, 0); }},
      {"time goes back",
       [](Cloths& one, btSoftBody& body) {
         Snapshot snapshot;
         snapshot.save(one.world().world(), one.solver());
         body.m_nodes[3].m_v.setY(1);
         for (int step = 0; step < 5; ++step) one.step();
         snapshot.restore(one.world().world(), one.solver());
       }},
  };
  return changes;
}

constexpr int kStepsToRest = 60;
constexpr int kStepsAfter = 20;

/// States of one body after each step.
using Course = std::vector<std::vector<Matrix3X<btScalar>>>;

/// The courses of all bodies, of which one is changed.
std::vector<Course> courses(Cloths& cloths, std::size_t count, const Change& change,
                            std::size_t changed) {
  for (int step = 0; step < kStepsToRest; ++step) cloths.step();
  change.make(cloths, cloths.body(changed));
  std::vector<Course> result(count);
  for (int step = 0; step < kStepsAfter; ++step) {
    cloths.step();
    for (std::size_t k = 0; k < count; ++k) result[k].push_back(cloths.state_of(k));
  }
  return result;
}

/// From where the cloth has come to rest when it is changed, and from where it lands just then [m].
constexpr double kHeights[] = {0.02, 4.95};

int num_solutions(const std::vector<TraceThread>& threads) {
  int count = 0;
  for (const TraceThread& thread : threads) {
    count += static_cast<int>(
        std::count_if(thread.events.begin(), thread.events.end(),
                      [](const TraceEvent& event) { return event.name == "implicit solve"; }));
  }
  return count;
}

// Without this the other tests would compare nothing.
TEST(BodyAlone, RepeatsStepsBeforeItIsChanged) {
  for (const bool together : {false, true}) {
    Cloths cloths(3, together, kHeights[0]);
    for (int step = 0; step < kStepsToRest; ++step) cloths.step();
    start_trace();
    cloths.step();
    EXPECT_EQ(num_solutions(stop_trace()) > 0, together);
  }
}

TEST(BodyAlone, FollowsEachChangeAsBodiesThatGoTogether) {
  for (const double height : kHeights) {
    for (const Change& change : changes_of_the_world()) {
      Cloths together(1, true, height);
      Cloths alone(1, false, height);
      EXPECT_EQ(courses(alone, 1, change, 0), courses(together, 1, change, 0))
          << change.name << " at " << height;
    }
  }
}

// Three bodies: the first one sets up its solver, the second one leaves a copy, the third one takes it.
class SharedSetUp : public testing::TestWithParam<double> {};

TEST_P(SharedSetUp, IsNotChangedByOneOfTheBodies) {
  for (const Change& change : changes_of_a_body()) {
    Cloths changed(1, true, GetParam());
    const Course of_changed = courses(changed, 1, change, 0)[0];
    Cloths left(1, true, GetParam());
    // Some changes take a step of their own.
    const bool takes_a_step = change.name.find("suspended") == 0 || change.name.find("out") == 0;
    const Change none{"", [&](Cloths& one, btSoftBody&) {
                        if (takes_a_step) one.step();
                      }};
    const Course of_left = courses(left, 1, none, 0)[0];
    for (const std::size_t number : {1, 2}) {
      Cloths three(3, false, GetParam());
      const std::vector<Course> found = courses(three, 3, change, number);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(found[k], k == number ? of_changed : of_left)
            << change.name << ", body " << k << " if " << number << " is changed";
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Heights, SharedSetUp, testing::ValuesIn(kHeights));

// A body that is added after the change shares the set-up that earlier bodies have left. It must not see the change.
TEST(BodyAlone, LeavesASolverBehindThatNothingChanges) {
  for (const Change& change : changes_of_a_body()) {
    if (change.name == "scale") continue;  // new bodies have other rest lengths then
    Cloths cloths(2, false, kHeights[0]);
    for (int step = 0; step < 5; ++step) cloths.step();
    change.make(cloths, cloths.body(1));
    cloths.step();
    const auto add = [](Cloths& one) -> btSoftBody& {
      btSoftBody& body =
          one.world().add(make_cloth_body(one.world().info(), one.mesh(), kSettings));
      EXPECT_FALSE(one.solver().attach_fast(body, one.mesh(), laws(300), {.may_sleep = false}));
      return body;
    };
    btSoftBody& third = add(cloths);
    Cloths none(0, false, kHeights[0]);
    btSoftBody& single = add(none);
    for (int step = 0; step < kStepsAfter; ++step) {
      cloths.step();
      none.step();
    }
    Matrix3X<btScalar> positions[2];
    Matrix3X<btScalar> velocities;
    read_nodes(third, positions[0], velocities);
    read_nodes(single, positions[1], velocities);
    EXPECT_EQ(positions[0], positions[1]) << change.name;
  }
}

TEST(BodyAlone, HasTheSameBitsOnAnyNumberOfThreads) {
  for (const Change& change : changes_of_a_body()) {
    const auto run = [&](int num_threads) {
      return with_threads(num_threads, [&] {
        Cloths three(3, false, kHeights[0]);
        return courses(three, 3, change, 1);
      });
    };
    EXPECT_EQ(run(1), run(2)) << change.name;
  }
}

}  // namespace
}  // namespace weft::bridge
