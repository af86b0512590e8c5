#include <weft/validation/cases/engines/collision_scenes.hpp>

#include <array>

#include <fmt/format.h>

#include <weft/mesh/icosphere.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::validation {
namespace collision_rows {
namespace {

// Mass: 250 g/m^2, a heavy cotton. Time step: by Gershgorin omega_max^2 <= 64 k / m at a corner, so with 26 nodes along
// each side omega_max dt <= 1.5 < 2; with the damping's 64 c dt / m = 0.44, (omega_max dt)^2 + 2 * 0.44 = 3.1 < 4.
// Drag: 4 / s, so that every cloth is at rest in two seconds; 8 / s where the reference would not converge else.
constexpr const char* kCloth = R"(
schema = "weft-scene/1"
name = "collision_{id}"

[world]
time_step = "1/2000 s"
duration = "{duration} s"
frame_interval = "1/50 s"

[[cloth]]
name = "cloth"
grid = {{ nodes = [{nodes}, {nodes}], size = ["60 cm", "60 cm"] }}
areal_density = "250 g/m^2"
collision_margin = "1 cm"
friction = {friction}
{start}

[[cloth.law]]
law = "gravity"

[[cloth.law]]
law = "tension"
stiffness = "20 N/m"

[[cloth.law]]
law = "spring_damping"
damping = "0.002 N*s/m"

[[cloth.law]]
law = "velocity_damping"
rate = "{drag} 1/s"

[[collider]]
name = "body"
{collider}

[camera]
position = ["0.9 m", "0.5 m", "1.3 m"]
target = ["0 m", "-0.13 m", "0 m"]
)";

constexpr const char* kHeldAtCorners =
    R"(pin = [{ corner = "-u-v" }, { corner = "+u-v" }, { corner = "-u+v" }, { corner = "+u+v" }])";

/// A mesh of 320 triangles in place of the sphere, 1.2 : 0.6 : 1.
void make_ellipsoid(scenes::Scene& scene) {
  const double radius = std::get<scenes::SphereShape>(scene.colliders[0].shape).radius;
  const ClothMesh mesh = make_icosphere(Icosphere{.radius = radius});
  scene.colliders[0].shape = scenes::MeshShape{
      Vector3<double>(1.2, 0.6, 1.0).asDiagonal() * mesh.rest_positions, mesh.triangles};
}

Sabotage stands_still() {
  Sabotage sabotage{"the body stands still"};
  sabotage.edit_scene = [](scenes::Scene& scene) {
    for (scenes::Collider& collider : scene.colliders) collider.path.reset();
  };
  return sabotage;
}

constexpr const char* kSphere = R"(shape = "sphere"
radius = "25 cm"
position = ["0 cm", "-25 cm", "0 cm"])";

constexpr const char* kLedSphere = R"(shape = "sphere"
radius = "12 cm"
path = { times = ["0 s", "0.5 s"], points = [["-10 cm", "-20 cm", "0 cm"], ["5 cm", "-8 cm", "3 cm"]] })";

constexpr double kDrag = 4.0;    // [1/s]
constexpr double kDamped = 8.0;  // [1/s]
/// Where folds form, differences grow before they decay: shorter steps.
constexpr int kFolding = 16;

// Each has one end that it must come to: held, nailed, off centre, and either without friction or with so much that
// nothing slides, for a sliding contact is not the same in Bullet's classic world. The last two rows slide.
constexpr std::array kScenes = {
    CollisionScene{.id = "sphere",
                   .start = R"(center = ["4 cm", "1 cm", "2 cm"]
pin = [{ sphere = { center = ["0 m", "1 cm", "0 m"], radius = "5 cm" } }])",
                   .collider = kSphere,
                   .finest_division = kFolding},
    CollisionScene{.id = "cylinder",
                   .start = R"(center = ["3 cm", "1.2 cm", "0 m"])",
                   .collider = R"(shape = "cylinder"
radius = "12 cm"
height = "1 m"
position = ["0 cm", "-12 cm", "0 cm"]
orientation = { axis = [1, 0, 0], angle = "90 deg" })",
                   .friction = 1.0,
                   .fine_drag = kDamped,
                   .finest_division = kFolding,
                   .late = &friction_removed},
    CollisionScene{.id = "table_edge",
                   .start = R"(center = ["0 m", "2 cm", "0 m"]
pin = [{ edge = "-u" }])",
                   .collider = R"(shape = "box"
size = ["60 cm", "40 cm", "1 m"]
position = ["-27 cm", "-20 cm", "0 cm"])",
                   .friction = 1.0,
                   .fine_drag = kDamped,
                   .finest_division = kFolding},
    CollisionScene{.id = "cone", .start = kHeldAtCorners, .collider = R"(shape = "cone"
radius = "25 cm"
height = "30 cm"
position = ["4 cm", "-17 cm", "2 cm"])"},
    CollisionScene{.id = "box",
                   .start = kHeldAtCorners,
                   .collider = R"(shape = "box"
size = ["25 cm", "20 cm", "25 cm"]
position = ["0 cm", "-13 cm", "0 cm"]
orientation = { axis = [0, 1, 0], angle = "20 deg" })",
                   .friction = 1.0},
    CollisionScene{.id = "capsule", .start = kHeldAtCorners, .collider = R"(shape = "capsule"
radius = "8 cm"
height = "25 cm"
position = ["3 cm", "-12 cm", "2 cm"]
orientation = { axis = [1, 0, 0.3], angle = "80 deg" })"},
    CollisionScene{.id = "mesh",
                   .start = kHeldAtCorners,
                   .collider = R"(shape = "sphere"
radius = "20 cm"
position = ["2 cm", "-15 cm", "4 cm"])",
                   .edit = &make_ellipsoid},
    CollisionScene{.id = "led_sphere",
                   .start = kHeldAtCorners,
                   .collider = kLedSphere,
                   .is_kinematic = true,
                   .early = &stands_still,
                   .late = &stands_still},
    CollisionScene{.id = "free_ball",
                   .start = kHeldAtCorners,
                   .collider = R"(shape = "sphere"
radius = "10 cm"
mass = "30 g"
position = ["0 cm", "12 cm", "0 cm"]
velocity = ["0 m/s", "-0.5 m/s", "0 m/s"])",
                   .duration = 5.0,
                   .late = &no_contact},
    CollisionScene{.id = "incline",
                   .start = "u_axis = [0.951056516, 0.309016994, 0]",
                   .collider = R"(shape = "plane"
position = ["-29 cm", "-13 cm", "0 cm"]
orientation = { axis = [0, 0, 1], angle = "20 deg" })",
                   .friction = 1.0,
                   .late = &friction_removed},
    CollisionScene{.id = "sliding_on_sphere",
                   .start = R"(center = ["4 cm", "3 cm", "2 cm"])",
                   .collider = kSphere,
                   .friction = 0.8,
                   .slides = true,
                   .finest_division = kFolding,
                   .late = &friction_removed},
    CollisionScene{.id = "sliding_on_led_sphere",
                   .start = kHeldAtCorners,
                   .collider = kLedSphere,
                   .friction = 0.8,
                   .is_kinematic = true,
                   .slides = true,
                   .early = &stands_still,
                   .late = &stands_still},
};

}  // namespace
}  // namespace collision_rows

Sabotage body_moved() {
  using namespace collision_rows;
  return colliders_moved({0.04, -0.05, 0.04});
}

std::span<const CollisionScene> collision_scenes() {
  using namespace collision_rows;
  return kScenes;
}

scenes::Scene written_collision_scene(const CollisionScene& scene, int nodes) {
  using namespace collision_rows;
  const std::string text =
      fmt::format(fmt::runtime(kCloth), fmt::arg("id", scene.id), fmt::arg("nodes", nodes),
                  fmt::arg("duration", scene.duration),
                  fmt::arg("drag", nodes >= kFoldingNodes ? scene.fine_drag : kDrag),
                  fmt::arg("start", scene.start), fmt::arg("friction", scene.friction),
                  fmt::arg("collider", scene.collider));
  scenes::Scene made = scenes::read_scene_text(text, fmt::format("collision_sweep/{}", scene.id));
  if (scene.edit) scene.edit(made);
  return made;
}

scenes::Scene make_collision_scene(const CollisionScene& scene, int nodes) {
  using namespace collision_rows;
  return scenes::with_bullets_time_step(written_collision_scene(scene, nodes));
}

}  // namespace weft::validation
