#include <weft/validation/cases/support/sabotage.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <weft/engines/reference_simulator.hpp>

namespace weft::validation {
namespace {

class NegatedLaw final : public forces::ForceLaw<double> {
 public:
  explicit NegatedLaw(std::unique_ptr<forces::ForceLaw<double>> law) : law_(std::move(law)) {}

  [[nodiscard]] const forces::LawInfo& info() const noexcept override { return law_->info(); }
  [[nodiscard]] Eigen::Index scratch_columns() const override { return law_->scratch_columns(); }

  void add_forces(const forces::State<double>& state, Matrix3XRef<double> scratch,
                  Matrix3XRef<double> forces) const override {
    Matrix3X<double> own = Matrix3X<double>::Zero(3, forces.cols());
    law_->add_forces(state, scratch, own);
    forces -= own;
  }

  void advance_velocities(const forces::State<double>& state, double time_step,
                          Matrix3XRef<double> velocities) const override {
    law_->advance_velocities(state, -time_step, velocities);
  }

 private:
  std::unique_ptr<forces::ForceLaw<double>> law_;
};

}  // namespace

std::unique_ptr<forces::ForceLaw<double>> negated(std::unique_ptr<forces::ForceLaw<double>> law) {
  return std::make_unique<NegatedLaw>(std::move(law));
}

Sabotage stiffness_scaled(double factor) {
  Sabotage sabotage{fmt::format("spring constant {:+.3g} %", 100 * (factor - 1))};
  sabotage.edit_scene = [factor](scenes::Scene& scene) {
    for (scenes::Cloth& cloth : scene.cloths) {
      for (forces::LawSpecification& law : cloth.laws) {
        if (law.law == "tension") law.parameters.at("stiffness").at(0) *= factor;
      }
    }
  };
  return sabotage;
}

Sabotage damping_sign() {
  Sabotage sabotage{"sign of the damping"};
  sabotage.flip_damping = true;
  return sabotage;
}

Sabotage one_step_dropped() {
  Sabotage sabotage{"one step dropped"};
  sabotage.drop_step = true;
  return sabotage;
}

Sabotage initial_velocity_unset() {
  Sabotage sabotage{"initial velocity unset"};
  sabotage.edit_scene = [](scenes::Scene& scene) {
    for (scenes::Cloth& cloth : scene.cloths) cloth.velocity.setZero();
    for (scenes::Collider& collider : scene.colliders) {
      collider.velocity.setZero();
      collider.angular_velocity.setZero();
    }
  };
  return sabotage;
}

Sabotage no_contact() {
  Sabotage sabotage{"no contact"};
  sabotage.edit_scene = [](scenes::Scene& scene) {
    // Far below everything: the bodies are there, and nothing meets them.
    for (scenes::Collider& collider : scene.colliders) collider.position.y() -= 1e4;
  };
  return sabotage;
}

Sabotage friction_removed() {
  Sabotage sabotage{"no friction"};
  sabotage.edit_scene = [](scenes::Scene& scene) {
    for (scenes::Cloth& cloth : scene.cloths) cloth.friction = 0.0;
  };
  return sabotage;
}

Sabotage wind_removed() {
  Sabotage sabotage{"no wind"};
  sabotage.edit_scene = [](scenes::Scene& scene) {
    for (scenes::Cloth& cloth : scene.cloths) {
      std::erase_if(cloth.laws,
                    [](const forces::LawSpecification& law) { return law.law == "wind"; });
    }
  };
  return sabotage;
}

Sabotage colliders_moved(const Vector3<double>& shift) {
  Sabotage sabotage{fmt::format("collider {:.3g} m off", shift.norm())};
  sabotage.edit_scene = [shift](scenes::Scene& scene) {
    for (scenes::Collider& collider : scene.colliders) collider.position += shift;
  };
  return sabotage;
}

std::vector<scenes::SceneState> run_sabotaged(scenes::Scene scene, const Sabotage& sabotage,
                                              double end_time) {
  sabotage.edit_scene(scene);
  const auto filter = [&](std::unique_ptr<forces::ForceLaw<double>> law) {
    const bool flip = sabotage.flip_damping && law->info().traits.dissipative;
    return flip ? negated(std::move(law)) : std::move(law);
  };
  const std::unique_ptr<scenes::Simulator> simulator = scenes::make_reference(filter);
  simulator->load(scene);
  const double time_step = scene.world.time_step;
  const long long num_steps = std::llround(end_time / time_step);
  const long long steps_per_frame = std::llround(scene.world.frame_interval / time_step);
  std::vector<scenes::SceneState> frames{simulator->state()};
  for (long long step = 1; step <= num_steps; ++step) {
    const bool dropped = sabotage.drop_step && step == 2;
    if (!dropped && simulator->step(time_step).blow_up) return frames;
    if (step % steps_per_frame == 0) frames.push_back(simulator->state());
  }
  return frames;
}

}  // namespace weft::validation
