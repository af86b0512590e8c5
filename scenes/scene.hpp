#pragma once

// Tested by tests/scenes/format/scene_file_test.cpp.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include <weft/custom_forces/law_info.hpp>
#include <weft/mesh/cloth_mesh.hpp>
#include <weft/scenes/appearance/appearance.hpp>
#include <weft/scenes/characters/character_settings.hpp>
#include <weft/scenes/cloth_source.hpp>
#include <weft/scenes/cloth_tear.hpp>
#include <weft/scenes/controllers/controller_settings.hpp>
#include <weft/scenes/drawn_cloth.hpp>
#include <weft/scenes/motion/path.hpp>
#include <weft/scenes/reference_settings.hpp>
#include <weft/scenes/shapes/shapes.hpp>

namespace weft::scenes {

/// A scene as every engine, recorder and report receives it: SI values, nothing left to guess.
/// Made by read_scene(); plain data, so that C++ users can also fill it by hand.

struct World {
  Vector3<double> gravity{0, -9.81, 0};  ///< [m/s^2]
  double time_step = 0.01;               ///< [s]
  double duration = 1.0;                 ///< [s]
  double frame_interval = 0.02;  ///< [s] between recorded frames; a whole number of time steps
  /// [s] of engines that solve springs implicitly, for which a step is short enough if contacts and pictures are right; none:
  /// time_step.
  std::optional<double> implicit_time_step = {};
};

/// Which nodes a pin holds. Corners and edges are those of a grid.
struct CornerPin {
  int u = 0;  ///< 0 = first column, -1 = last column
  int v = 0;  ///< 0 = first row, -1 = last row
};
struct EdgePin {
  int axis = 0;  ///< 0: all nodes with the given column, 1: with the given row
  int side = 0;  ///< 0 = first, -1 = last
};
struct BoxPin {
  Vector3<double> minimum;  ///< [m]
  Vector3<double> maximum;  ///< [m]
};
struct SpherePin {
  Vector3<double> center;  ///< [m]
  double radius;           ///< [m]
};
struct NodePin {
  std::vector<int> nodes;  ///< at least one
};
using Pin = std::variant<CornerPin, EdgePin, BoxPin, SpherePin, NodePin>;

/// Nodes that are pinned and move: with a constant velocity, with a frame that follows a path, or
/// with a collider.
struct MovingPin {
  Pin nodes;
  Vector3<double> velocity{0, 0, 0};  ///< [m/s], without a path
  std::optional<Path> path = {};      ///< each node keeps its place in the frame of the start
  /// Name of a collider without a mass that carries the nodes, exactly and without lag; empty: none.
  std::string to = {};
};

/// A named set of nodes, for drive.
struct Region {
  std::string name;
  std::vector<Pin> nodes;  ///< all nodes that one of these holds
  /// Also makes an edge set of this name: the springs with both ends in the region, for laws that
  /// shall be stronger there.
  bool has_springs = false;
};

/// The rest shape of a grid, raised around its centre along its normal by
/// height (1 - (r / radius)^2)^2, 0 from the radius on.
struct Bulge {
  double height;  ///< [m]
  double radius;  ///< [m], > 0
};

/// Ties of one node to far ones, for nonlocal_torsion.
struct Connection {
  std::string name;
  std::array<int, 2> node{0, 0};  ///< column and row; negative values count from the far side
  std::vector<Pin> to;            ///< regions of far nodes; empty: every other node
  /// Number of the node, in place of column and row; a source that is no grid needs it.
  std::optional<int> node_number = std::nullopt;
};

struct Cloth {
  std::string name;
  ClothSource source = ClothGrid();
  std::vector<Pin> pins;
  std::optional<Bulge> bulge = std::nullopt;  ///< of a grid
  std::vector<MovingPin> moving_pins = {};    ///< a node of several moves with the last of them
  std::vector<Connection> connections = {};
  std::vector<Region> regions = {};
  Vector3<double> velocity{0, 0, 0};  ///< [m/s] of every free node at the start
  double collision_margin = 0.01;     ///< [m] distance at which the cloth rests on a surface, >= 0
  double friction =
      0.5;  ///< Coulomb coefficient of the cloth [-]; with a collider: the product of both
  std::vector<forces::LawSpecification> laws;
  std::optional<ClothTear> tear = std::nullopt;  ///< none: it never tears
  bool self_collision = false;
  /// [m] distance that layers of the cloth keep, > 0; none: twice collision_margin
  std::optional<double> self_thickness = std::nullopt;
  bool soft_collision = false;  ///< with the other cloths that say so too

  /// The source as a grid. Throws InvalidArgument if it is something else.
  [[nodiscard]] ClothGrid& grid();
  [[nodiscard]] const ClothGrid& grid() const;
  Appearance appearance = {};
  std::optional<DrawnCloth> drawn_mesh = std::nullopt;  ///< none: its own triangles are drawn
};

/// A rigid collider; with a mass it is a dynamic rigid body that the cloth pushes back.
struct Collider {
  std::string name;
  Shape shape;
  Vector3<double> position{0, 0, 0};  ///< [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  double friction = 1.0;                      ///< [-]
  std::optional<double> mass = std::nullopt;  ///< [kg]; none: fixed
  Vector3<double> velocity{0, 0, 0};          ///< [m/s], dynamic bodies only
  Vector3<double> angular_velocity{0, 0, 0};  ///< [rad/s], dynamic bodies only
  Appearance appearance = {};
  /// Leads the centre, absolute [m]; turns beyond orientation. The collider has no mass then and
  /// position is the path's at time 0.
  std::optional<Path> path = std::nullopt;
  /// Name of the character whose bone leads the collider; empty: none.
  std::string led_by = {};
};

/// How Bullet's classic soft-body world meets a mesh or a height field, which are not convex.
enum class ConcaveContact {
  kPrisms,     ///< as a compound of convex solids behind its triangles
  kTriangles,  ///< as Bullet does by itself: each triangle grown to a slab of 6 cm to both sides
};

/// Settings of Bullet's own solver, for the engines that use it.
struct BulletSettings {
  int position_iterations = 20;  ///< >= 1; how often Bullet visits each link and contact per step
  ConcaveContact concave = ConcaveContact::kPrisms;
};

struct Camera {
  Vector3<double> position{8, 6, 10};  ///< [m]
  Vector3<double> target{0, 1, 0};     ///< [m]
  double field_of_view = 0.6;          ///< vertical [rad]
  std::string follow = {};             ///< name of a body that it keeps in view; empty: none
  /// [s] of the most telling picture; none: the last one.
  std::optional<double> poster_time = std::nullopt;
};

struct Scene {
  std::string name;     ///< identifier, [a-z0-9_]+
  std::string summary;  ///< one sentence, "Shows ..."
  /// Names of the engines that the scene is made for, the first one is run by default. Empty: all.
  std::vector<std::string> engines = {};
  World world;
  std::vector<Cloth> cloths;
  std::vector<Collider> colliders;
  std::vector<ControllerSettings> controllers = {};
  std::vector<CharacterSettings> characters = {};
  BulletSettings bullet;
  ReferenceSettings reference;
  Camera camera;
  std::vector<SceneFile> files = {};  ///< those that appearances name, each once
};

/// Mesh of a cloth with its pins, connections and regions resolved to node indices.
/// Throws InvalidArgument if a pin, a region or the far end of a connection holds no node, if one of
/// them names a node that is not there, and for corners and edges of what is no grid.
[[nodiscard]] ClothMesh make_mesh(const Cloth& cloth);

/// The nodes of its mesh that a pin or region of the cloth holds, sorted.
[[nodiscard]] std::vector<int> nodes_of(const Pin& pin, const Cloth& cloth, const ClothMesh& mesh);
/// Whether the scene is made for the engine of this name.
[[nodiscard]] bool is_for_engine(const Scene& scene, std::string_view engine);

/// The scene with the time step that it has for the engine of this name: World::implicit_time_step for bullet_weft. Engines that are
/// to be compared take time_step instead.
[[nodiscard]] Scene with_step_of(Scene scene, std::string_view engine);

/// The scene with the time step that Bullet takes, which it rounds to single precision in both
/// builds, for all engines; duration and frame interval keep their numbers of steps. Engines that are to be compared
/// must take the same step.
[[nodiscard]] Scene with_bullets_time_step(Scene scene);

}  // namespace weft::scenes
