#include <weft/validation/contact_table/contact_table.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include <weft/validation/contact_table/passage.hpp>

namespace weft::validation {
namespace {

constexpr std::string_view kCsvHeader =
    "target,time_step_s,speed_m_per_s,nodes,deepest_mm,deepest_at_end_mm,tunnelled,blew_up\n";

bool begins_as_csv(std::string_view beginning) {
  return beginning.starts_with(kCsvHeader);
}

bool begins_as_markdown(std::string_view beginning) {
  return beginning.starts_with("Engine `") &&
         beginning.find("Per cell: deepest node in the run") != std::string_view::npos;
}

constexpr double kMargin = 0.02;    // [m]
constexpr double kGap = 0.05;       // [m] to go before the margin is reached
constexpr double kClothSize = 1.0;  // [m]
constexpr int kNodes = 21;          // along one side
/// [s] from the meeting on: what tunnels has passed by then, what rests has come to rest.
constexpr double kDuration = 0.75;
constexpr double kLedDistance = 0.6;  // [m] that a kinematic collider goes before and after

scenes::Cloth thrown_cloth(double speed, double margin) {
  scenes::Cloth cloth;
  cloth.name = "cloth";
  cloth.grid().nodes = {kNodes, kNodes};
  cloth.grid().size = {kClothSize, kClothSize};
  cloth.grid().total_mass = 0.25;
  cloth.grid().center = {0, kGap + kMargin, 0};
  cloth.velocity = {0, -speed, 0};
  cloth.collision_margin = margin;
  cloth.friction = 0.5;
  cloth.laws = {{"gravity", {}, {{"acceleration", {0, -9.81, 0}}}},
                {"tension", {}, {{"stiffness", {10.0}}}},
                {"velocity_damping", {}, {{"rate", {1.0}}}}};
  return cloth;
}

double led_duration(double speed) {
  return 1.5 * 2.0 * kLedDistance / speed;
}

/// From rest to rest, through `meeting` half way, where it is fastest: 1.5 times the mean.
scenes::Path led_path(const Vector3<double>& meeting, double speed) {
  const Vector3<double> half(0, -kLedDistance, 0);
  scenes::Path path;
  path.times = {0.0, led_duration(speed)};
  path.points = {meeting - half, meeting + half};
  return path;
}

}  // namespace

scenes::Scene contact_scene(const ContactTarget& target, double time_step, double speed,
                            const ContactSabotage& sabotage) {
  using Mover = ContactTarget::Mover;
  scenes::Scene scene;
  scene.name = "contact_table";
  scene.world.time_step = time_step;
  const double meeting =
      target.mover == Mover::kKinematic ? 0.5 * led_duration(speed) : kGap / speed;
  scene.world.duration = std::ceil((kDuration + meeting) / time_step) * time_step;
  scene.world.frame_interval = time_step;
  scene.bullet.position_iterations = 10;
  scene.bullet.concave = target.concave;
  scene.cloths = {thrown_cloth(target.mover == Mover::kCloth ? speed : 0.0,
                               sabotage.no_margin ? 0.0 : kMargin)};
  scenes::Collider collider = target.collider;
  if (target.mover != Mover::kCloth) {
    // The other way round: the collider falls, its lowest point above the cloth.
    scene.cloths[0].grid().center = Vector3<double>::Zero();
    for (const int axis : {0, 1}) {
      for (const int side : {0, -1}) scene.cloths[0].pins.emplace_back(scenes::EdgePin{axis, side});
    }
    collider.position.y() = target.radius + kMargin + kGap;
  }
  if (target.mover == Mover::kKinematic) {
    collider.position.y() -= kGap;
    collider.path = led_path(collider.position, speed);
    collider.position = collider.path->points.front();
  }
  if (target.mover == Mover::kDynamic) {
    collider.mass = 1.0;
    collider.velocity = {0, -speed, 0};
  }
  if (sabotage.no_contact) collider.position.x() += 100.0;
  scene.colliders = {collider};
  return scene;
}

ContactRow measure_contact(scenes::Simulator& engine, const ContactTarget& target, double time_step,
                           double speed, const ContactSabotage& sabotage) {
  const scenes::Scene scene = contact_scene(target, time_step, speed, sabotage);
  engine.load(scene);
  // A sabotaged collider is measured where it should have been.
  const double displaced = sabotage.no_contact ? -100.0 : 0.0;
  Passage passage(target.collider.shape, target.radius);
  const auto look = [&] {
    const scenes::RigidState& rigid = engine.state().rigids[0];
    const Vector3<double> place = rigid.position + Vector3<double>(displaced, 0, 0);
    passage.add({place, rigid.orientation}, engine.state().cloths[0].positions);
  };
  ContactRow row{target.name, time_step, speed, kNodes * kNodes};
  look();
  const auto num_steps = static_cast<int>(std::round(scene.world.duration / time_step));
  for (int step = 0; step < num_steps && !row.blew_up; ++step) {
    row.blew_up = engine.step(time_step).blow_up.has_value();
    if (!row.blew_up) look();
  }
  row.deepest = passage.deepest();
  row.deepest_end = passage.deepest_now();
  row.num_tunnelled = passage.num_tunnelled();
  return row;
}

const output::FileKind kContactCsvKind{"a contact table (CSV)", begins_as_csv};
const output::FileKind kContactMarkdownKind{"a contact table (Markdown)", begins_as_markdown};

std::string contact_csv(const std::vector<ContactRow>& rows) {
  std::string text(kCsvHeader);
  for (const ContactRow& row : rows) {
    text += fmt::format("\"{}\",{:.6f},{:g},{},{:.2f},{:.2f},{},{}\n", row.target, row.time_step,
                        row.speed, row.num_nodes, 1e3 * row.deepest, 1e3 * row.deepest_end,
                        row.num_tunnelled, row.blew_up ? "yes" : "no");
  }
  return text;
}

std::string contact_markdown(const std::vector<ContactRow>& rows, const std::string& engine) {
  std::string text = fmt::format(
      "Engine {}. Per cell: deepest node in the run / at its end [mm], tunnelled of {} nodes.\n\n",
      engine, rows.empty() ? 0 : rows.front().num_nodes);
  std::string rule = "|---|";
  text += "| Collider |";
  for (const double time_step : kTableTimeSteps) {
    for (const double speed : kTableSpeeds) {
      text += fmt::format(" 1/{:.0f} s, {:g} m/s |", 1.0 / time_step, speed);
      rule += "---|";
    }
  }
  text += "\n" + rule;
  std::string target;
  for (const ContactRow& row : rows) {
    if (row.target != target) text += fmt::format("\n| {} |", row.target);
    target = row.target;
    const std::string numbers = fmt::format("{:.1f} / {:.1f}, {}", 1e3 * row.deepest,
                                            1e3 * row.deepest_end, row.num_tunnelled);
    text += row.blew_up ? " blows up |" : fmt::format(" {} |", numbers);
  }
  return text + "\n";
}

}  // namespace weft::validation
