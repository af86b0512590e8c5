// A robot's gripper takes the rim of a towel by friction alone, carries it over to the opposite rim, lays it down and withdraws:
// the towel lies folded in half. Where Weft's recorder is installed, an argument is the recording to make.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <weft/weft.hpp>

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#ifdef WITH_RECORDER
#include <weft/recorder/recorder.hpp>
#endif

namespace {

namespace laws = weft::laws;
using Point = weft::Vector3<double>;
using Points = weft::Matrix3X<double>;

// Robots are mostly simulated in such steps. In those of 1/60 s the towel is folded too, but one step in seven ends by its budget.
constexpr double kStep = 1 / 240.0;  // [s]
constexpr double kGravity = 9.81;    // [m/s^2]
constexpr double kPi = 3.14159265358979;

constexpr int kColumns = 19;          // of nodes
constexpr int kRows = 25;             // of nodes, from the rim that is taken to the opposite one
constexpr double kWidth = 0.3;        // [m]
constexpr double kLength = 0.4;       // [m]
constexpr double kMass = 0.048;       // [kg], 400 g/m^2: terry
constexpr double kStiffness = 1000;   // [N/m] of a spring along a thread; a twentieth across
constexpr double kRigidity = 6e-5;    // [N m]: over an edge it hangs in a bow of some 2.5 cm
constexpr double kFriction = 0.5;     // on table and fingers, and of its layers on each other
constexpr double kMargin = 0.004;     // [m] at which it rests on a surface
constexpr double kThickness = 0.004;  // [m] at which its layers rest on each other
constexpr double kTolerance = 0.01;   // [-] of a step, as games have it

constexpr double kGrip = 4;               // [N] on each side
constexpr double kMotor = 1000;           // [N], [N m] of the other joints
constexpr double kHalfThickness = 0.008;  // [m] of a finger
constexpr double kHalfLength = 0.02;      // [m] of a finger
constexpr double kReach = 0.055;          // [m] from the wrist to the middle of the fingers
constexpr double kOpen = 0.03;            // [m] that each finger stands off
constexpr double kOverhang = 0.035;       // [m] of the rim over the table's edge
constexpr double kRim =
    0.195;  // [m] from the fold to the middle of the fingers, over two rows of nodes
constexpr double kRise = 0.16;   // [m] of the fingers' way over the fold
constexpr double kLaid = 0.036;  // [m] above the table, where the fingers end
constexpr double kDrag = 0.012;  // [m] by which they drag the rim along as they withdraw
constexpr double kLast =
    kPi - 0.35;  // where the wrist ends: it points down a little, so that the rim slides off

btVector3 vector(double x, double y, double z) {
  return {btScalar(x), btScalar(y), btScalar(z)};
}

/// From 0 to 1, at rest at both ends.
double smooth(double share) {
  return share * share * share * (10 + share * (6 * share - 15));
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

/// A gantry (lift and traverse) with a wrist that turns about x, and two fingers that close across the wrist's direction.
class Robot {
 public:
  enum Joint { kLift, kTraverse, kWrist, kStanding, kPressing, kNumJoints };

  /// Where the middle of the fingers is [m], and where the wrist points: 0 is along -z, pi / 2 down, pi along z.
  struct Pose {
    double y, z, angle;
  };

  Robot(btSoftMultiBodyDynamicsWorld& world, const Pose& pose) : world_(world) {
    body_.setHasSelfCollision(true);  // the fingers press on each other
    add_slider(kLift, -1, vector(0, 1, 0), vector(0, 0.5, 0), 1);
    add_slider(kTraverse, kLift, vector(0, 0, 1), vector(0, -0.25, 0), 1);
    body_.setupRevolute(kWrist, btScalar(0.5), vector(1e-3, 1e-3, 1e-3), kTraverse,
                        btQuaternion::getIdentity(), vector(-1, 0, 0), vector(0, -0.25, 0),
                        vector(0, 0, 0), true);
    add_slider(kStanding, kWrist, vector(0, 1, 0), vector(0, -kHalfThickness, -kReach), 0.1);
    add_slider(kPressing, kWrist, vector(0, 1, 0), vector(0, kHalfThickness, -kReach), 0.1);
    body_.finalizeMultiDof();
    targets_ = {0, 0, 0, -kOpen, kOpen};
    set_targets(pose);
    for (int joint = 0; joint < kNumJoints; ++joint) {
      body_.setJointPos(joint, btScalar(targets_[joint]));
    }
    world.addMultiBody(&body_);
    add_colliders();
    for (int joint = 0; joint < kNumJoints; ++joint) {
      const double force = joint == kPressing ? kGrip : kMotor;
      motors_[joint] = std::make_unique<btMultiBodyJointMotor>(
          &body_, joint, btScalar(0), btScalar(force * kStep));  // its limit is an impulse
      motors_[joint]->finalizeMultiDof();
      world.addMultiBodyConstraint(motors_[joint].get());
    }
    lead();
  }
  ~Robot() {
    for (const auto& motor : motors_) world_.removeMultiBodyConstraint(motor.get());
    for (const auto& collider : colliders_) world_.removeCollisionObject(collider.get());
    world_.removeMultiBody(&body_);
  }
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  /// The pose at the end of the next step.
  void go_to(const Pose& pose) {
    set_targets(pose);
    lead();
  }
  /// Where the standing finger is at the end of the next step [m]: 0 is closed, -kOpen open.
  void move_finger(double position) {
    targets_[kStanding] = position;
    lead();
  }
  /// The other finger closes until something stops it, and presses on that with the force of its motor.
  void press(double speed) {
    motors_[kPressing]->setPositionTarget(0, 0);
    motors_[kPressing]->setVelocityTarget(btScalar(-speed));
  }
  [[nodiscard]] const btCollisionObject& collider(Joint joint) const { return *colliders_[joint]; }
  [[nodiscard]] bool is_finger(const btCollisionObject* object) const {
    return object == colliders_[kStanding].get() || object == colliders_[kPressing].get();
  }
  /// A point as the standing finger sees it.
  [[nodiscard]] btVector3 in_finger(const btVector3& point) const {
    return colliders_[kStanding]->getWorldTransform().invXform(point);
  }

 private:
  void set_targets(const Pose& pose) {
    targets_[kLift] = pose.y + kReach * std::sin(pose.angle);
    targets_[kTraverse] = pose.z + kReach * std::cos(pose.angle);
    targets_[kWrist] = pose.angle;
  }
  /// All joints but that of the finger that presses.
  void lead() {
    for (int joint = 0; joint < kPressing; ++joint) {
      motors_[joint]->setPositionTarget(btScalar(targets_[joint]), 1);
    }
    if (!is_started_) motors_[kPressing]->setPositionTarget(btScalar(targets_[kPressing]), 1);
    is_started_ = true;
  }
  void add_slider(int joint, int parent, const btVector3& axis, const btVector3& place,
                  double mass) {
    const btVector3 inertia = vector(1e-3, 1e-3, 1e-3);
    body_.setupPrismatic(joint, btScalar(mass), inertia, parent, btQuaternion::getIdentity(), axis,
                         place, vector(0, 0, 0), true);
  }
  void add_colliders() {
    for (int joint = 0; joint < kNumJoints; ++joint) {
      auto collider = std::make_unique<btMultiBodyLinkCollider>(&body_, joint);
      collider->setCollisionShape(shapes_[joint].get());
      collider->setFriction(1);
      body_.getLink(joint).m_collider = collider.get();
      world_.addCollisionObject(collider.get(), btBroadphaseProxy::DefaultFilter,
                                btBroadphaseProxy::AllFilter);
      colliders_[joint] = std::move(collider);
    }
    btAlignedObjectArray<btQuaternion> rotations;
    btAlignedObjectArray<btVector3> origins;
    body_.forwardKinematics(rotations, origins);
    body_.updateCollisionObjectWorldTransforms(rotations, origins);
  }
  static std::unique_ptr<btBoxShape> box(double x, double y, double z) {
    return std::make_unique<btBoxShape>(vector(x, y, z));
  }

  btSoftMultiBodyDynamicsWorld& world_;
  btMultiBody body_{kNumJoints, 0, vector(0, 0, 0), true, false};
  std::array<std::unique_ptr<btBoxShape>, kNumJoints> shapes_{
      box(0.02, 0.02, 0.4), box(0.015, 0.24, 0.015), box(0.06, 0.012, 0.012),
      box(0.17, kHalfThickness, kHalfLength), box(0.17, kHalfThickness, kHalfLength)};
  std::array<std::unique_ptr<btMultiBodyLinkCollider>, kNumJoints> colliders_;
  std::array<std::unique_ptr<btMultiBodyJointMotor>, kNumJoints> motors_;
  std::array<double, kNumJoints> targets_{};
  bool is_started_ = false;
};

Points points_of(const btSoftBody& body) {
  Points points(3, body.m_nodes.size());
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btVector3& x = body.m_nodes[i].m_x;
    points.col(i) =
        Point(static_cast<double>(x.x()), static_cast<double>(x.y()), static_cast<double>(x.z()));
  }
  return points;
}

/// The heights of the nodes of the half that was taken over the other half, where they are above or below it [m].
std::vector<double> heights_over_lower_half(const weft::ClothMesh& mesh, const Points& points) {
  std::vector<double> heights;
  const auto is_taken = [&](int i) { return mesh.rest_positions(2, i) > 1e-6; };
  for (int i = 0; i < points.cols(); ++i) {
    if (!is_taken(i)) continue;
    for (int t = 0; t < mesh.triangles.cols(); ++t) {
      const auto corners = mesh.triangles.col(t);
      if (is_taken(corners[0]) || is_taken(corners[1]) || is_taken(corners[2])) continue;
      const Point a = points.col(corners[0]);
      const Point b = points.col(corners[1]) - a;
      const Point c = points.col(corners[2]) - a;
      const Point p = points.col(i) - a;
      const double area = b.x() * c.z() - c.x() * b.z();  // twice that, seen from above
      const double u = (p.x() * c.z() - c.x() * p.z()) / area;
      const double v = (b.x() * p.z() - p.x() * b.z()) / area;
      if (u >= 0 && v >= 0 && u + v <= 1) heights.push_back(p.y() - u * b.y() - v * c.y());
    }
  }
  return heights;
}

/// The largest stretch of a thread between two nodes [-].
double largest_stretch(const weft::Edges& threads, const Points& rest, const Points& points) {
  double most = 0;
  for (int e = 0; e < threads.cols(); ++e) {
    const auto length = [&](const Points& x) {
      return (x.col(threads(1, e)) - x.col(threads(0, e))).norm();
    };
    most = std::max(most, length(points) / length(rest) - 1);
  }
  return most;
}

/// Table, towel and robot, and what is seen while they move.
class Scene {
 public:
  Scene() {
    btSoftBodyWorldInfo& info = all_.world.getWorldInfo();
    all_.world.setGravity(vector(0, -kGravity, 0));
    info.m_gravity = all_.world.getGravity();
    info.m_sparsesdf.Initialize();
    table_.getWorldTransform().setOrigin(vector(0, -0.02, kLength / 2 - kOverhang - 0.25));
    table_.setFriction(1);
    all_.world.addRigidBody(&table_);
    body_ = weft::bridge::make_cloth_body(info, mesh_,
                                          {.collision_margin = kMargin, .friction = kFriction});
    all_.world.addSoftBody(body_.get());
  }
  ~Scene() {
    all_.world.removeSoftBody(body_.get());
    all_.world.removeRigidBody(&table_);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Returns why the towel cannot be stepped, if so.
  std::optional<std::string> attach() {
    auto refusal = all_.solver.attach_fast(
        *body_, mesh_,
        {laws::tension({.stiffness = kStiffness, .sets = {"stretch"}}),
         laws::tension({.stiffness = kStiffness / 20, .sets = {"shear"}}),
         laws::hinge_torsion({.rigidity = kRigidity}), laws::velocity_damping({.rate = 1.0})},
        {.solver = {.tolerance = kTolerance}});
    if (refusal) return refusal;
    all_.solver.set_cloth_contact(
        *body_, {.with_itself = true, .self_thickness = kThickness, .friction = kFriction});
    towel_ = all_.solver.cloth(*body_);
    return std::nullopt;
  }

  /// Steps for a time [s]. before: called before each step, with the share of the time at its end.
  void run(double seconds, const std::function<void(double)>& before = {}) {
    const auto num_steps = std::lround(seconds / kStep);
    for (int n = 1; n <= num_steps; ++n) {
      if (before) before(double(n) / double(num_steps));
      step();
    }
  }
  /// The nodes that friction holds on the fingers.
  [[nodiscard]] int num_held() const {
    std::set<int> held;
    for (const auto& contact : towel_.contacts()) {
      if (robot_.is_finger(contact.object) && contact.is_sticking) held.insert(contact.node);
    }
    return static_cast<int>(held.size());
  }
  /// The middle of the rim that is taken, as the finger sees it.
  [[nodiscard]] btVector3 held_in_finger() const {
    return robot_.in_finger(body_->m_nodes[kColumns / 2].m_x);
  }
  [[nodiscard]] Points velocities() const {
    Points velocities(3, body_->m_nodes.size());
    for (int i = 0; i < body_->m_nodes.size(); ++i) {
      const btVector3& v = body_->m_nodes[i].m_v;
      velocities.col(i) = Point(double(v.x()), double(v.y()), double(v.z()));
    }
    return velocities;
  }
  [[nodiscard]] Robot& robot() { return robot_; }
  [[nodiscard]] const weft::ClothMesh& mesh() const { return mesh_; }
  [[nodiscard]] Points points() const { return points_of(*body_); }
  [[nodiscard]] bool has_blown_up() const { return towel_.state().blow_up.has_value(); }
  [[nodiscard]] int num_steps() const { return num_steps_; }
  [[nodiscard]] int num_unsolved() const { return num_unsolved_; }
  [[nodiscard]] double stretch() const { return stretch_; }
  [[nodiscard]] double most_stretch() const { return most_stretch_; }

#ifdef WITH_RECORDER
  void record_to(const char* path) {
    recorder_.emplace(path, weft::recorder::RecorderOptions{
                                .name = "folding_towel",
                                .frame_interval = 1 / 30.0,
                                .view = weft::recorder::View{{0.55, 0.42, 0.5}, {0, 0.04, -0.03}},
                                .may_replace = true});
    recorder_->add(*body_, "towel");
    recorder_->add(table_, "table");
    recorder_->add(robot_.collider(Robot::kWrist), "wrist");
    recorder_->add(robot_.collider(Robot::kStanding), "standing_finger");
    recorder_->add(robot_.collider(Robot::kPressing), "pressing_finger");
  }
#endif

 private:
  void step() {
    all_.world.stepSimulation(btScalar(kStep), 0);
    ++num_steps_;
    if (!towel_.state().step_error.is_within_tolerance) ++num_unsolved_;
    const Points now = points();
    stretch_ = largest_stretch(threads_, mesh_.rest_positions, now);
    most_stretch_ = std::max(most_stretch_, stretch_);
#ifdef WITH_RECORDER
    if (recorder_) recorder_->record(num_steps_ * kStep);
#endif
  }

  World all_;
  weft::ClothMesh mesh_ = weft::make_cloth_grid({.nodes = {kColumns, kRows},
                                                 .size = {kWidth, kLength},
                                                 .center = {0, kMargin, 0},
                                                 .stencil = weft::GridStencil::k8Neighbour,
                                                 .total_mass = kMass});
  weft::Edges threads_ = mesh_.edges_of({"stretch"});
  btBoxShape board_{vector(0.3, 0.02, 0.25)};
  btRigidBody table_{btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &board_)};
  std::unique_ptr<btSoftBody> body_;
  weft::bridge::Cloth towel_;
  Robot robot_{all_.world, {kMargin, kRim, 0}};
#ifdef WITH_RECORDER
  std::optional<weft::recorder::Recorder> recorder_;
#endif
  int num_steps_ = 0;
  int num_unsolved_ = 0;
  double stretch_ = 0;  ///< after the last step
  double most_stretch_ = 0;
};

/// The fingers close on the rim that hangs over the table's edge.
void take_rim(Scene& scene) {
  Robot& robot = scene.robot();
  scene.run(0.5);
  scene.run(0.5, [&](double share) { robot.move_finger(-kOpen * (1 - smooth(share))); });
  robot.press(0.08);
  scene.run(0.6);
}

/// They carry it in an arc over the middle of the towel, and turn half around. Returns whether friction has held it.
bool carry_rim(Scene& scene) {
  const btVector3 before = scene.held_in_finger();
  const int first = scene.num_steps();
  int sum = 0;
  scene.run(4, [&](double part) {
    sum += scene.num_held();
    const double share = smooth(part);
    scene.robot().go_to({kMargin + (kLaid - kMargin) * share + kRise * std::sin(kPi * share),
                         kRim * std::cos(kPi * share) + kDrag * share, kLast * share});
  });
  const double held = double(sum) / (scene.num_steps() - first);
  const double slip = static_cast<double>((scene.held_in_finger() - before).length());
  std::printf("carried by friction alone: %.1f nodes stuck on average, the rim slipped %.2f mm\n",
              held, 1000 * slip);
  // Half a row of nodes; those that slide by micrometers are borne by friction as well.
  return held > kColumns / 2 && slip < kHalfLength / 10;
}

/// The upper finger opens, and both leave backwards, as the wrist points.
void let_go(Scene& scene) {
  Robot& robot = scene.robot();
  scene.run(0.3);
  robot.press(0);
  scene.run(0.4, [&](double share) { robot.move_finger(-0.02 * smooth(share)); });
  scene.run(1.5, [&](double share) {
    const double way = 0.15 * smooth(share);
    robot.go_to({kLaid + way * std::sin(kLast), kDrag - kRim + way * std::cos(kLast), kLast});
  });
}

/// Two layers of half the length, the one that was taken on the other.
bool is_folded(const Scene& scene) {
  const Points points = scene.points();
  const double extent = points.row(2).maxCoeff() - points.row(2).minCoeff();
  const double rims = points.row(2).head(kColumns).mean() - points.row(2).tail(kColumns).mean();
  const std::vector<double> heights = heights_over_lower_half(scene.mesh(), points);
  const int num_upper = kRows / 2 * kColumns;
  const double lowest = heights.empty() ? 0 : *std::min_element(heights.begin(), heights.end());
  std::printf(
      "folded: %.3f m of %.1f m, rims %.1f mm apart; %d of %d nodes on the other half, %.2f mm "
      "above it and more\n",
      extent, kLength, 1000 * rims, static_cast<int>(heights.size()), num_upper, 1000 * lowest);
  // A finger lays a rim down with a precision of half its length. Of the 12 rows two are the bow of the fold, and one may be
  // beyond the other rim.
  const bool are_over = 4 * static_cast<int>(heights.size()) > 3 * num_upper;
  const bool are_rims_together = std::abs(rims) < kHalfLength;
  return are_over && are_rims_together && std::abs(extent - kLength / 2) < kHalfLength &&
         lowest > kThickness / 2;
}

bool is_at_rest(Scene& scene) {
  const Points start = scene.points();
  scene.run(1);
  const double moved = std::sqrt((scene.points() - start).colwise().squaredNorm().maxCoeff());
  const Points before = scene.velocities();
  const double span = 0.1;  // [s]
  scene.run(span);
  const Points after = scene.velocities();
  const auto mean = [](const Points& x) { return std::sqrt(x.squaredNorm() / double(x.cols())); };
  const double unbalanced = mean(after - before) / (span * kGravity);
  const double stretch = scene.stretch();
  std::printf(
      "at rest: no node has moved by more than %.2f mm in 1 s, speed %.2f mm/s, unbalanced force "
      "%.3f of the weight, stretch %.2f %%\n",
      1000 * moved, 1000 * mean(after), unbalanced, 100 * stretch);
  // Layers may settle by a quarter of their thickness; 5 mm/s is FastSettings::sleep_speed. Threads bear next to nothing there.
  return moved < kThickness / 4 && mean(after) < 0.005 && unbalanced < 0.01 && stretch < 0.01;
}

}  // namespace

int main(int argc, char** argv) {
  Scene scene;
  if (const auto refusal = scene.attach()) return std::fprintf(stderr, "%s\n", refusal->c_str()), 2;
#ifdef WITH_RECORDER
  if (argc > 1) scene.record_to(argv[1]);
#else
  if (argc > 1) return std::fprintf(stderr, "%s records nothing here\n", argv[0]), 2;
#endif
  take_rim(scene);
  std::printf("%d nodes of %d stick to the fingers\n", scene.num_held(), 2 * kColumns);
  const bool is_carried = carry_rim(scene);
  let_go(scene);
  scene.run(2);
  const bool is_free = scene.num_held() == 0;
  const bool is_right = is_folded(scene) && is_at_rest(scene);
  std::printf("largest stretch %.2f %%, %d of %d steps not solved to tolerance\n",
              100 * scene.most_stretch(), scene.num_unsolved(), scene.num_steps());
  // In a step in which layers meet, what parts them are impulses that know no springs.
  const bool is_whole = !scene.has_blown_up() && scene.most_stretch() < 0.1 &&
                        scene.num_unsolved() < scene.num_steps() / 20;
  return is_carried && is_free && is_right && is_whole ? 0 : 1;
}
