// A robot's gripper takes a towel by friction alone, lifts it, carries it aside and lets it go.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include <weft/weft.hpp>

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

namespace {

constexpr double kStep = 1 / 60.0;  // [s]
constexpr double kGrip = 3;         // [N] on each side: holds 3 N with a friction of 0.5 there
constexpr double kMotor = 1000;     // [N] of the other joints

btVector3 vector(double x, double y, double z) {
  return {btScalar(x), btScalar(y), btScalar(z)};
}

/// Bullet's world for robots; the solver is the one line for Weft.
struct World {
  weft::bridge::SoftBodySolver solver;
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver constraints;
  btSoftMultiBodyDynamicsWorld world{&dispatcher, &broadphase, &constraints, &configuration,
                                     &solver};
};

/// A fixed base, a lift, a traverse along z, and two fingers that close along x.
class Robot {
 public:
  enum Joint { kLift, kTraverse, kLeft, kRight, kNumJoints };

  explicit Robot(btSoftMultiBodyDynamicsWorld& world) : world_(world) {
    body_.setHasSelfCollision(true);  // the fingers press on each other
    add_slider(kLift, -1, vector(0, 1, 0), vector(0, 0.1, 0), 1);
    add_slider(kTraverse, kLift, vector(0, 0, 1), vector(0, 0.04, 0), 1);
    add_slider(kLeft, kTraverse, vector(1, 0, 0), vector(-0.05, -0.16, 0), 0.2);
    add_slider(kRight, kTraverse, vector(1, 0, 0), vector(0.05, -0.16, 0), 0.2);
    body_.finalizeMultiDof();
    world.addMultiBody(&body_);
    for (int joint = 0; joint < kNumJoints; ++joint) {
      auto collider = std::make_unique<btMultiBodyLinkCollider>(&body_, joint);
      collider->setCollisionShape(joint < kLeft ? &beam_ : &pad_);
      collider->setFriction(1);
      body_.getLink(joint).m_collider = collider.get();
      world.addCollisionObject(collider.get(), btBroadphaseProxy::DefaultFilter,
                               btBroadphaseProxy::AllFilter);
      colliders_[joint] = std::move(collider);
    }
    btAlignedObjectArray<btQuaternion> rotations;
    btAlignedObjectArray<btVector3> origins;
    body_.forwardKinematics(rotations, origins);
    body_.updateCollisionObjectWorldTransforms(rotations, origins);
    for (int joint = 0; joint < kNumJoints; ++joint) {
      const double force = joint == kRight ? kGrip : kMotor;
      motors_[joint] = std::make_unique<btMultiBodyJointMotor>(
          &body_, joint, btScalar(0), btScalar(force * kStep));  // its limit is an impulse
      motors_[joint]->finalizeMultiDof();
      world.addMultiBodyConstraint(motors_[joint].get());
    }
  }
  ~Robot() {
    for (const auto& motor : motors_) world_.removeMultiBodyConstraint(motor.get());
    for (const auto& collider : colliders_) world_.removeCollisionObject(collider.get());
    world_.removeMultiBody(&body_);
  }
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  void run(double seconds) {
    for (int step = 0; step < std::lround(seconds / kStep); ++step) {
      if (closes_ && body_.getJointPos(kLeft) > btScalar(0.03)) set_speed(kLeft, 0);
      world_.stepSimulation(btScalar(kStep), 0);
    }
  }
  void close() {
    closes_ = true;
    set_speed(kLeft, 0.1);
    set_speed(kRight, -0.1);
  }
  void open() {
    closes_ = false;
    set_speed(kLeft, -0.2);
    set_speed(kRight, 0.2);
  }
  /// Accelerates and brakes with a tenth of g: a load that comes at once counts twice.
  void travel(Joint joint, double speed, double seconds) {
    const auto num_steps = static_cast<int>(std::lround(seconds / kStep));
    for (int step = 0; step < num_steps; ++step) {
      set_speed(joint, std::min(speed, std::min(step, num_steps - 1 - step) * kStep));
      run(kStep);
    }
    set_speed(joint, 0);
  }
  /// A point as the left finger sees it.
  [[nodiscard]] btVector3 in_finger(const btVector3& point) const {
    return colliders_[kLeft]->getWorldTransform().invXform(point);
  }

 private:
  void add_slider(int joint, int parent, const btVector3& axis, const btVector3& place,
                  double mass) {
    const btVector3 inertia = vector(1e-3, 1e-3, 1e-3);
    body_.setupPrismatic(joint, btScalar(mass), inertia, parent, btQuaternion::getIdentity(), axis,
                         place, vector(0, 0, 0), true);
  }
  void set_speed(Joint joint, double speed) { motors_[joint]->setVelocityTarget(btScalar(speed)); }

  btSoftMultiBodyDynamicsWorld& world_;
  btMultiBody body_{kNumJoints, 0, vector(0, 0, 0), true, false};
  btBoxShape beam_{vector(0.1, 0.01, 0.01)};
  btBoxShape pad_{vector(0.02, 0.03, 0.12)};
  std::array<std::unique_ptr<btMultiBodyLinkCollider>, kNumJoints> colliders_;
  std::array<std::unique_ptr<btMultiBodyJointMotor>, kNumJoints> motors_;
  bool closes_ = false;
};

/// 100 g that hang by two corners, which are pinned.
weft::ClothMesh make_towel() {
  weft::ClothMesh mesh = weft::make_cloth_grid(
      {.nodes = {17, 17}, .size = {0.4, 0.4}, .total_mass = 0.1});  // flat, in x and z
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    const weft::Vector3<double> flat = mesh.rest_positions.col(i);
    mesh.rest_positions.col(i) = weft::Vector3<double>(0, flat.z() - 0.2, flat.x());
    if (flat.z() > 0.199 && std::abs(flat.x()) > 0.199) mesh.pinned.push_back(i);
  }
  return mesh;
}

int middle_of_upper_rim(const weft::ClothMesh& mesh) {
  int middle = 0;
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    if (mesh.rest_positions.col(i).norm() < mesh.rest_positions.col(middle).norm()) middle = i;
  }
  return middle;
}

}  // namespace

int main() {
  World all;
  all.world.getWorldInfo().m_gravity = all.world.getGravity();
  all.world.getWorldInfo().m_sparsesdf.Initialize();
  Robot robot(all.world);
  const weft::ClothMesh mesh = make_towel();
  const auto body = weft::bridge::make_cloth_body(all.world.getWorldInfo(), mesh,
                                                  {.collision_margin = 0.004, .friction = 0.5});
  all.world.addSoftBody(body.get());
  const auto refusal = all.solver.attach_fast(
      *body, mesh,
      {weft::laws::tension({.stiffness = 2000.0}), weft::laws::velocity_damping({.rate = 2.0})});
  if (refusal) return std::fprintf(stderr, "%s\n", refusal->c_str()), 2;
  const weft::bridge::Cloth towel = all.solver.cloth(*body);
  const btVector3& held = body->m_nodes[middle_of_upper_rim(mesh)].m_x;

  robot.close();
  robot.run(1);
  for (const int corner : mesh.pinned) {  // the line lets go
    body->m_nodes[corner].m_im = btScalar(1 / mesh.masses[corner]);
  }
  robot.run(1);
  const btVector3 start = held;
  robot.travel(Robot::kLift, 0.2, 1.5);
  robot.travel(Robot::kTraverse, 0.2, 1.5);
  robot.run(1);
  const btVector3 carried = held - start;
  const auto contacts = towel.contacts();
  const auto num_held = std::count_if(contacts.begin(), contacts.end(),
                                      [](const auto& contact) { return contact.is_sticking; });
  std::printf("carried %.3f m up and %.3f m aside by %d nodes that stick\n",
              static_cast<double>(carried.y()), static_cast<double>(carried.z()),
              static_cast<int>(num_held));

  const btVector3 before = robot.in_finger(held);
  robot.run(5);
  const double slip = static_cast<double>((robot.in_finger(held) - before).length());
  const btVector3 top = held;
  robot.open();
  robot.run(0.75);
  const double fallen = static_cast<double>((top - held).y());
  std::printf("slipped %.2f mm in 5 s, fell %.2f m in 0.75 s\n", 1000 * slip, fallen);
  all.world.removeSoftBody(body.get());
  const bool is_carried = carried.y() > btScalar(0.2) && carried.z() > btScalar(0.2);
  return is_carried && num_held > 10 && slip < 1e-3 && fallen > 0.5 ? 0 : 1;
}
