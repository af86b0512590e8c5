#include <weft/custom_forces/set_up_warnings.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/custom_forces/spectrum.hpp>
#include <weft/mesh/topology/triangle_quality.hpp>

namespace weft::forces {
namespace {

using Kind = SetUpWarning::Kind;

constexpr double kDegrees = 57.29577951308232;

std::string short_text(double value) {
  char text[32];
  (void)std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

class Warnings {
 public:
  explicit Warnings(const ClothSetUp& set_up)
      : set_up_(set_up),
        quality_(triangle_quality(set_up.mesh.rest_positions, set_up.mesh.triangles, kSharpAngle)) {
  }

  std::vector<SetUpWarning> find() {
    look_at_steps();
    look_at_mesh();
    for (const SetUpCollider& collider : set_up_.colliders) look_at(collider);
    look_at_cloth_contact();
    look_at_world();
    std::stable_sort(list_.begin(), list_.end(),
                     [](const auto& a, const auto& b) { return a.kind < b.kind; });
    return std::move(list_);
  }

 private:
  void add(Kind kind, std::string message) { list_.push_back({kind, std::move(message)}); }

  void look_at_steps() {
    if (set_up_.is_always_stable) return look_at_stiffness();
    if (set_up_.laws.empty()) return;
    const double stable = set_up_.stable_time_step ? *set_up_.stable_time_step
                                                   : critical_time_step(set_up_.mesh, set_up_.laws);
    if (!(set_up_.time_step > stable)) return;
    add(Kind::kUnstableStep,
        "the time step " + short_text(set_up_.time_step) + " s is longer than " +
            short_text(stable) +
            " s, up to which explicit springs are stable at the rest shape: the cloth will blow "
            "up; take shorter steps, softer springs, or an implicit solver");
  }

  // The stiffest law of springs, at the lightest node that one of its springs has: an upper bound, exact for equal springs.
  void look_at_stiffness() {
    const ClothMesh& mesh = set_up_.mesh;
    const std::vector<char> is_pinned = pinned_flags();
    double largest = 0;
    for (const LawSpecification& law : set_up_.laws) {
      if (role_of(law.law) != LawRole::kSpring) continue;
      const double stiffness = checked(law).parameters.at("stiffness")[0];
      const Edges edges = mesh.edges_of(sets_of(law));
      for (Eigen::Index e = 0; e < edges.cols(); ++e) {
        for (const int node : {edges(0, e), edges(1, e)}) {
          if (is_pinned[static_cast<std::size_t>(node)] == 0) {
            largest = std::max(largest, stiffness / mesh.masses[node]);
          }
        }
      }
    }
    const double share = largest * set_up_.time_step * set_up_.time_step;
    if (!(share > set_up_.most_stiffness)) return;
    add(Kind::kSofterSprings,
        "springs have k h^2 / m = " + short_text(share) + ", and steps are solved with at most " +
            short_text(set_up_.most_stiffness) + ": they will be " +
            short_text(share / set_up_.most_stiffness) +
            " times as soft; take shorter steps, heavier nodes or double precision");
  }

  /// A law without sets acts on all.
  [[nodiscard]] std::vector<std::string> sets_of(const LawSpecification& law) const {
    if (!law.sets.empty()) return law.sets;
    std::vector<std::string> all;
    for (const EdgeSet& set : set_up_.mesh.edge_sets) all.push_back(set.name);
    return all;
  }

  [[nodiscard]] std::vector<char> pinned_flags() const {
    std::vector<char> is_pinned(static_cast<std::size_t>(set_up_.mesh.num_nodes()), 0);
    for (const int node : set_up_.mesh.pinned) is_pinned[static_cast<std::size_t>(node)] = 1;
    return is_pinned;
  }

  void look_at_mesh() {
    if (quality_.num_sharp > 0) {
      add(Kind::kSharpTriangles,
          std::to_string(quality_.num_sharp) + " of " +
              std::to_string(set_up_.mesh.triangles.cols()) + " triangles have an angle below " +
              short_text(kSharpAngle * kDegrees) + " degrees, triangle " +
              std::to_string(quality_.sharpest) + " one of " +
              short_text(quality_.smallest_angle * kDegrees) +
              ": their short edges limit the time step and spoil bending; mesh the surface anew");
    }
    if (!set_up_.is_single_precision || set_up_.mesh.num_nodes() == 0) return;
    const double farthest = set_up_.mesh.rest_positions.cwiseAbs().maxCoeff();
    const double rounding = farthest * std::numeric_limits<float>::epsilon() / 2;
    if (!(quality_.shortest_edge > 0 && rounding > kLargestRounding * quality_.shortest_edge))
      return;
    add(Kind::kFarFromOrigin, "nodes are up to " + short_text(farthest) +
                                  " m from the origin, where single precision has " +
                                  short_text(rounding) + " m, beside edges of " +
                                  short_text(quality_.shortest_edge) +
                                  " m; move the scene to the origin or take double precision");
  }

  void look_at(const SetUpCollider& collider) {
    const double half = collider.least_half_extent;
    const double middle = collider.middle_half_extent;
    if (middle + set_up_.margin < quality_.largest_gap) {
      add(Kind::kGapBetweenNodes, "'" + collider.name + "', " + short_text(2 * middle) +
                                      " m wide, may pass between nodes, which leave room for " +
                                      short_text(2 * quality_.largest_gap) +
                                      " m; with a margin of " + short_text(set_up_.margin) +
                                      " m on each side that takes a finer mesh or a larger margin");
    }
    const double way = (set_up_.speed + collider.speed) * set_up_.time_step;
    if (!set_up_.is_swept && way > 2 * (half + set_up_.margin)) {
      add(Kind::kThinCollider,
          "'" + collider.name + "', " + short_text(2 * half) + " m thin, and the cloth come " +
              short_text(way) + " m towards each other in a step of " +
              short_text(set_up_.time_step) +
              " s, and contacts are looked for at its end only; take shorter steps");
    }
    if (!collider.mass || set_up_.mesh.masses.size() == 0) return;
    const double ratio = *collider.mass / set_up_.mesh.masses.sum();
    if (ratio > kLargestMassRatio || ratio * kLargestMassRatio < 1) {
      add(Kind::kMassRatio, "'" + collider.name + "' has " + short_text(ratio) +
                                " times the mass of the cloth, which no test covers; expected " +
                                short_text(1 / kLargestMassRatio) + " to " +
                                short_text(kLargestMassRatio));
    }
  }

  void look_at_cloth_contact() {
    if (set_up_.keeps_layers_apart) return;
    const bool meets_itself = set_up_.layer_distance > 0;
    const double longest = set_up_.meets_cloth ? kLongestStepWithLayers : kLongestStepWithItself;
    // Steps of 1/150 s, rounded to single precision, are not longer.
    if ((meets_itself || set_up_.meets_cloth) && set_up_.time_step > longest * (1 + 1e-6)) {
      add(Kind::kLayersInLongSteps,
          std::string(set_up_.meets_cloth ? "layers of cloths" : "a cloth that meets itself") +
              " may be thrown about in steps of " + short_text(set_up_.time_step) +
              " s; expected at most " + short_text(longest) + " s");
    }
    // Contact is of nodes with faces: a node is caught by a face before edges of the two layers have passed each other.
    if (meets_itself && set_up_.layer_distance < quality_.shortest_edge / 2) {
      add(Kind::kThinLayers, "layers keep " + short_text(set_up_.layer_distance) +
                                 " m from each other, less than half of the shortest edge, " +
                                 short_text(quality_.shortest_edge) +
                                 " m: their edges may pass each other; take a larger thickness or "
                                 "a finer mesh");
    }
  }

  void look_at_world() {
    const bool has_law = std::any_of(set_up_.laws.begin(), set_up_.laws.end(), [](const auto& law) {
      return role_of(law.law) == LawRole::kGravity;
    });
    const double strength = set_up_.world_gravity.norm();
    if (!has_law || !(strength > 0)) return;
    add(Kind::kGravityTwice,
        "a gravity law acts beside the gravity of the world, " + short_text(strength) +
            " m/s^2: both pull; leave out the law, or set the world's to zero");
  }

  const ClothSetUp& set_up_;
  TriangleQuality quality_;
  std::vector<SetUpWarning> list_;
};

}  // namespace

std::string_view name_of(SetUpWarning::Kind kind) {
  constexpr std::array<std::string_view, 10> kNames = {
      "unstable_step",   "softer_springs", "sharp_triangles",      "gap_between_nodes",
      "thin_collider",   "mass_ratio",     "layers_in_long_steps", "thin_layers",
      "far_from_origin", "gravity_twice"};
  return kNames.at(static_cast<std::size_t>(kind));
}

std::vector<SetUpWarning> find_warnings(const ClothSetUp& set_up) {
  if (!(set_up.time_step > 0) || !std::isfinite(set_up.time_step)) {
    throw InvalidArgument("warnings: time_step = " + short_text(set_up.time_step) +
                          " s, expected > 0 and finite");
  }
  return Warnings(set_up).find();
}

}  // namespace weft::forces
