#include <weft/validation/cases/scenes/scene_bounds.hpp>

#include <cmath>
#include <limits>
#include <utility>

namespace weft::validation {
namespace {

const EngineChoice kWeft32{"bullet_weft", scenes::StoredPrecision::kFloat32};
const EngineChoice kWeft64{"bullet_weft", scenes::StoredPrecision::kFloat64};
const EngineChoice kSoft32{"bullet_soft", scenes::StoredPrecision::kFloat32};
const EngineChoice kSoft64{"bullet_soft", scenes::StoredPrecision::kFloat64};
const EngineChoice kForces32{"bullet_forces", scenes::StoredPrecision::kFloat32};
const EngineChoice kForces64{"bullet_forces", scenes::StoredPrecision::kFloat64};

constexpr double kFirstHalfSecond = 0.5;  // [s]

/// Same equations, same order of operations: what is left is the order of additions inside a sum,
/// and that Bullet takes velocities from differences of positions.
Tolerance same_equations() {
  return {
      1e-9, Basis::kRoundoff,
      "both solve the same equations in double precision; rounding of 1e-16 per step grows with "
      "the motion and stays a thousand times below this"};
}

/// Bullet derives each velocity from a difference of positions: an error of eps x / h per step,
/// adding up as a random walk over n steps, and moving the node over the whole time.
Tolerance single_precision(double size, double time_step, double duration) {
  const double epsilon = std::numeric_limits<float>::epsilon();
  const double num_steps = duration / time_step;
  return {epsilon * size / time_step * std::sqrt(num_steps) * duration, Basis::kRoundoff,
          "eps size / h per step in the velocity, sqrt(n) of it after n steps, times the duration"};
}

Tolerance model_gap(double value, const char* why) {
  return {value, Basis::kModelGap, why};
}

const char* const kLinksWhy =
    "links are projected one after the other in Bullet, springs act together in the reference";
const char* const kContactWhy =
    "planes of contact are found where a step would end and held there, in the reference by "
    "impulses at its start; after the first touch folds amplify every difference";

const char* const kLongStepWhy =
    "steps of 1/100 s with a method of order 1: 3.0e-3 of it is that, the same in every engine; "
    "the rest is contact";
const char* const kFoldsWhy =
    "folds may fall either way: node by node two steps of the reference end 0.5 % of the size "
    "apart, which a "
    "number of the whole shape does not see";

const char* const kFastWhy =
    "in motion steps of 1/100 s damp as a method of order 1 does where something touches the "
    "cloth; "
    "the bound is that of the collision sweep, measured up to 1.4 % there with 1/250 s";
const char* const kFastNote = "the fast solver's damping, its iterations, or its contacts";

const char* const kSameEquationsNote =
    "compare the order of operations in a step, the masses, or Bullet's single-precision time step";
const char* const kContactNote = "contact hardness, margin, or friction of the Bullet engine";
const char* const kLinksNote = "the map from N/m to kLST, and Bullet's link order";

SceneBound step_for_step(Quantity quantity, double end, std::vector<Sabotage> sabotages) {
  return {kForces64,
          "follows the reference step for step",
          quantity,
          0.0,
          end,
          same_equations(),
          std::move(sabotages),
          kSameEquationsNote};
}

SceneBound near(const EngineChoice& engine, double begin, double end, Tolerance tolerance,
                std::vector<Sabotage> sabotages, const char* note) {
  return {engine,
          "stays near the reference",
          Quantity::kRmsDistance,
          begin,
          end,
          std::move(tolerance),
          std::move(sabotages),
          note,
          Against::kSolution};
}

SceneBound stays_outside(const EngineChoice& engine, double end, double depth, const char* why) {
  return {engine,
          "no node goes deep into a collider",
          Quantity::kDepth,
          0.0,
          end,
          model_gap(depth, why),
          {no_contact()},
          kContactNote};
}

const char* const kMarginWhy =
    "the margin is there to keep nodes out; this much remains of it at the fastest approach";

std::vector<SceneBound> drape_sphere() {
  const double free_fall = 0.28;  // [s]: the middle touches at sqrt(2 * 0.48 m / g) = 0.313 s
  const double end = 6.0;
  std::vector<SceneBound> bounds{
      step_for_step(Quantity::kLargestDistance, free_fall, {one_step_dropped(), damping_sign()})};
  for (const EngineChoice& engine : {kForces32, kForces64}) {
    bounds.push_back(near(engine, 0, kFirstHalfSecond, model_gap(0.005, kLongStepWhy),
                          {no_contact(), one_step_dropped()}, kContactNote));
    bounds.push_back({engine,
                      "drapes as the reference does",
                      Quantity::kMeanHeight,
                      end - 1,
                      end,
                      model_gap(0.005, kFoldsWhy),
                      {no_contact(), colliders_moved({0.5, 0, 0})},
                      kContactNote,
                      Against::kSeeds});
    bounds.push_back({engine,
                      "drapes as the reference does",
                      Quantity::kMeanRadius,
                      end - 1,
                      end,
                      model_gap(0.01, kFoldsWhy),
                      {no_contact()},  // a draped cloth is as wide on a ball elsewhere
                      kContactNote,
                      Against::kSeeds});
  }
  for (const EngineChoice& engine : {kSoft32, kSoft64}) {
    bounds.push_back(near(engine, 0, kFirstHalfSecond, model_gap(0.005, kLinksWhy),
                          {no_contact(), one_step_dropped()}, kLinksNote));
  }
  for (const EngineChoice& engine : {kSoft32, kSoft64, kForces32, kForces64, kReference}) {
    bounds.push_back(stays_outside(engine, end, 0.02, kMarginWhy));
  }
  return bounds;
}

/// In the first half second. size: of the scene [m].
SceneBound within_single_precision(double size, double time_step, std::vector<Sabotage> sabotages) {
  return {kForces32,
          "follows the reference within single precision",
          Quantity::kLargestDistance,
          0.0,
          kFirstHalfSecond,
          single_precision(size, time_step, kFirstHalfSecond),
          std::move(sabotages),
          kSameEquationsNote};
}

std::vector<SceneBound> hang() {
  const double size = 1.0;              // [m]
  const double time_step = 1.0 / 2000;  // [s]
  std::vector<SceneBound> bounds{step_for_step(
      Quantity::kLargestDistance, kFirstHalfSecond,
      {stiffness_scaled(1.01), damping_sign(), one_step_dropped(), initial_velocity_unset()})};
  bounds.push_back(within_single_precision(
      size, time_step, {stiffness_scaled(1.2), damping_sign(), initial_velocity_unset()}));
  for (const EngineChoice& engine : {kSoft32, kSoft64}) {
    bounds.push_back(near(engine, 0, kFirstHalfSecond, model_gap(0.02, kLinksWhy),
                          {initial_velocity_unset()}, kLinksNote));
  }
  return bounds;
}

std::vector<SceneBound> drop_ground() {
  std::vector<SceneBound> bounds{step_for_step(Quantity::kLargestDistance, 0.12,
                                               {one_step_dropped(), initial_velocity_unset()})};
  for (const EngineChoice& engine : {kForces32, kForces64}) {
    for (const double begin : {0.0, 1.5}) {
      bounds.push_back(near(engine, begin, begin + kFirstHalfSecond, model_gap(0.01, kContactWhy),
                            {no_contact(), initial_velocity_unset()}, kContactNote));
    }
  }
  for (const EngineChoice& engine : {kSoft32, kSoft64, kForces32, kForces64, kReference}) {
    bounds.push_back(stays_outside(engine, 2.0, 0.01, kMarginWhy));
  }
  return bounds;
}

std::vector<SceneBound> drop_box() {
  std::vector<SceneBound> bounds{
      step_for_step(Quantity::kLargestDistance, 0.18, {one_step_dropped(), damping_sign()})};
  for (const EngineChoice& engine : {kForces32, kForces64, kSoft32, kSoft64}) {
    const bool links = engine.engine == "bullet_soft";
    bounds.push_back(near(engine, 0, kFirstHalfSecond,
                          model_gap(links ? 0.03 : 0.005, links ? kLinksWhy : kContactWhy),
                          {no_contact(), colliders_moved({0.2, 0, 0})},
                          links ? kLinksNote : kContactNote));
    if (links) continue;
    for (const Quantity quantity : {Quantity::kMeanHeight, Quantity::kMeanRadius}) {
      bounds.push_back({engine,
                        "drapes as the reference does",
                        quantity,
                        1.5,
                        2.0,
                        model_gap(0.01, kFoldsWhy),
                        {no_contact()},
                        kContactNote,
                        Against::kSeeds});
    }
  }
  for (const EngineChoice& engine : {kSoft32, kSoft64, kForces32, kForces64, kReference}) {
    bounds.push_back(stays_outside(engine, 2.0, 0.02, kMarginWhy));
  }
  return bounds;
}

std::vector<SceneBound> ball_on_cloth() {
  const double before_contact = 0.14;  // [s]: the ball meets the cloth at about 0.17 s
  std::vector<SceneBound> bounds{
      step_for_step(Quantity::kLargestDistance, before_contact,
                    {stiffness_scaled(1.01), damping_sign(), one_step_dropped()}),
      step_for_step(Quantity::kRigidDistance, before_contact,
                    {initial_velocity_unset(), one_step_dropped()})};
  for (const EngineChoice& engine : {kForces32, kForces64, kSoft32, kSoft64}) {
    const bool links = engine.engine == "bullet_soft";
    bounds.push_back(near(engine, 0, kFirstHalfSecond,
                          model_gap(links ? 0.03 : 0.01, links ? kLinksWhy : kContactWhy),
                          {no_contact(), initial_velocity_unset()},
                          links ? kLinksNote : kContactNote));
    bounds.push_back({engine,
                      "the ball is pushed back as in the reference",
                      Quantity::kRigidDistance,
                      0.0,
                      kFirstHalfSecond,
                      model_gap(links ? 0.05 : 0.02, links ? kLinksWhy : kContactWhy),
                      {no_contact(), initial_velocity_unset()},
                      kContactNote,
                      Against::kSolution});
  }
  return bounds;
}

std::vector<SceneBound> wind_hover() {
  const double size = 1.0;              // [m]
  const double time_step = 1.0 / 2000;  // [s]
  std::vector<SceneBound> bounds{
      step_for_step(Quantity::kLargestDistance, kFirstHalfSecond,
                    {wind_removed(), one_step_dropped(), initial_velocity_unset()})};
  bounds.push_back(
      within_single_precision(size, time_step, {wind_removed(), initial_velocity_unset()}));
  // Flat and hardly stretched, the cloth shows little of the links: 3.5e-4 of it is the step of modified Euler. Single
  // precision shows more.
  for (const auto& [engine, gap] : {std::pair{kSoft32, 0.004}, std::pair{kSoft64, 0.001}}) {
    bounds.push_back(near(engine, 0, kFirstHalfSecond, model_gap(gap, kLinksWhy),
                          {wind_removed(), initial_velocity_unset()}, kLinksNote));
  }
  return bounds;
}

std::vector<SceneBound> heavy_strip() {
  const double size = 0.2;               // [m]
  const double time_step = 1.0 / 10000;  // [s]
  std::vector<SceneBound> bounds{step_for_step(Quantity::kLargestDistance, kFirstHalfSecond,
                                               {damping_sign(), one_step_dropped()})};
  bounds.push_back({kForces32,
                    "follows the reference within single precision",
                    Quantity::kLargestDistance,
                    0.0,
                    kFirstHalfSecond,
                    single_precision(size, time_step, kFirstHalfSecond),
                    {damping_sign()},
                    kSameEquationsNote});
  for (const EngineChoice& engine : {kSoft32, kSoft64}) {
    bounds.push_back(near(engine, 0, kFirstHalfSecond, model_gap(0.02, kLinksWhy), {damping_sign()},
                          kLinksNote));
  }
  return bounds;
}

/// The fast solver in every scene, with the long steps that it is made for.
std::vector<SceneBound> fast_bounds(const std::string& scene) {
  const bool drapes = scene == "drape_sphere" || scene == "drop_box";
  const bool has_air = scene == "hang" || scene == "wind_hover" || scene == "heavy_strip";
  const bool is_strip = scene == "heavy_strip";
  const double end = scene == "drape_sphere" ? 6.0 : 2.0;  // [s]
  // A ball changes little of a cloth that has just met it: 0.16 % measured, 1.8 % without it.
  const double largest = scene == "drape_sphere" ? 0.005 : 0.03;
  std::vector<SceneBound> bounds;
  for (const EngineChoice& engine : {kWeft32, kWeft64}) {
    std::vector<Sabotage> mistakes{no_contact()};
    if (is_strip) mistakes = {damping_sign()};
    if (has_air && !is_strip) mistakes = {initial_velocity_unset()};
    bounds.push_back(
        near(engine, 0, kFirstHalfSecond, model_gap(largest, kFastWhy), mistakes, kFastNote));
    if (!has_air && scene != "ball_on_cloth") {
      bounds.push_back(stays_outside(engine, end, 0.02, kMarginWhy));
    }
    if (!drapes) continue;
    for (const Quantity quantity : {Quantity::kMeanHeight, Quantity::kMeanRadius}) {
      bounds.push_back({engine,
                        "drapes as the reference does",
                        quantity,
                        scene == "drape_sphere" ? end - 1 : end - 0.5,
                        end,
                        model_gap(0.01, kFoldsWhy),
                        {no_contact()},
                        kFastNote,
                        Against::kSeeds});
    }
  }
  return bounds;
}

std::vector<SceneBound> other_bounds(const std::string& scene) {
  if (scene == "drape_sphere") return drape_sphere();
  if (scene == "hang") return hang();
  if (scene == "drop_ground") return drop_ground();
  if (scene == "drop_box") return drop_box();
  if (scene == "ball_on_cloth") return ball_on_cloth();
  if (scene == "wind_hover") return wind_hover();
  if (scene == "heavy_strip") return heavy_strip();
  return {};
}

}  // namespace

std::vector<SceneBound> scene_bounds(const std::string& scene) {
  std::vector<SceneBound> bounds = other_bounds(scene);
  if (bounds.empty()) return bounds;
  for (SceneBound& bound : fast_bounds(scene)) bounds.push_back(std::move(bound));
  return bounds;
}

}  // namespace weft::validation
