#include <weft/validation/recordings/recording_difference.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include <weft/scenes/recording/frame_times.hpp>
#include <weft/scenes/torn_cloth.hpp>
#include <weft/validation/metrics/distance/vertex_distance.hpp>

namespace weft::validation {
namespace {

bool is_same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

template <class Values>
bool is_same_vector(const Values& a, const Values& b) {
  return std::equal(a.data(), a.data() + a.size(), b.data(), b.data() + b.size(), is_same);
}

bool is_same_topology(const scenes::ClothState& a, const scenes::ClothState& b) {
  if (!a.topology || !b.topology) return a.topology == b.topology;
  const Triangles& p = a.topology->triangles;
  const Triangles& q = b.topology->triangles;
  return p.cols() == q.cols() && p == q && a.topology->origins == b.topology->origins;
}

bool is_same_blow_up(const std::optional<scenes::BlowUp>& a,
                     const std::optional<scenes::BlowUp>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->step == b->step && is_same(a->time, b->time) && a->body == b->body &&
         a->node == b->node && a->reason == b->reason;
}

/// The first column of two matrices of the same size that has other bits.
std::optional<int> first_differing_node(const Matrix3X<double>& a, const Matrix3X<double>& b) {
  const auto values = std::mismatch(a.data(), a.data() + a.size(), b.data(), is_same);
  if (values.first == a.data() + a.size()) return std::nullopt;
  return static_cast<int>((values.first - a.data()) / 3);
}

struct Place {
  std::string quantity;
  std::optional<int> node;
};

std::optional<Place> first_difference(const scenes::ClothState& a, const scenes::ClothState& b) {
  if (a.positions.cols() != b.positions.cols()) return Place{"number of nodes", {}};
  if (!is_same_topology(a, b)) return Place{"topology", {}};
  if (const auto node = first_differing_node(a.positions, b.positions)) {
    return Place{"position", node};
  }
  if (const auto node = first_differing_node(a.velocities, b.velocities)) {
    return Place{"velocity", node};
  }
  return std::nullopt;
}

std::optional<Place> first_difference(const scenes::RigidState& a, const scenes::RigidState& b) {
  if (!is_same_vector(a.position, b.position)) return Place{"position", {}};
  if (!is_same_vector(a.orientation.coeffs(), b.orientation.coeffs())) {
    return Place{"orientation", {}};
  }
  if (!is_same_vector(a.velocity, b.velocity)) return Place{"velocity", {}};
  if (!is_same_vector(a.angular_velocity, b.angular_velocity)) return Place{"angular velocity", {}};
  return std::nullopt;
}

/// A body of both recordings, by its places among the cloths or the rigid bodies.
struct Pair {
  std::size_t a;
  std::size_t b;
  ClothMesh mesh = {};                                              ///< of a cloth in a
  std::shared_ptr<const scenes::ClothTopology> topology = nullptr;  ///< to which weights belong
  VectorX<double> weights = {};
  double sum_of_squares = 0.0;  ///< of the rms at each time [m^2]
  bool is_apart = false;        ///< from here on its nodes are no longer the same
};

class Comparison {
 public:
  Comparison(const scenes::RecordingReader& a, const scenes::RecordingReader& b) : a_(a), b_(b) {
    result_.num_frames_a = a.num_frames();
    result_.num_frames_b = b.num_frames();
    result_.is_same_precision = a.precision() == b.precision();
    result_.is_same_blow_up = is_same_blow_up(a.blow_up(), b.blow_up());
    match(a.scene().cloths, b.scene().cloths, true);
    match(a.scene().colliders, b.scene().colliders, false);
  }

  RecordingDifference run(const std::function<void(double)>& progress) {
    const std::vector<scenes::CommonFrame> frames = scenes::common_frames(a_, b_);
    for (const scenes::CommonFrame& frame : frames) {
      look_at(frame, a_.frame(frame.a), b_.frame(frame.b));
      ++result_.num_common;
      if (progress) progress(static_cast<double>(result_.num_common) / std::ssize(frames));
    }
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      BodyDifference& body = result_.bodies[i];
      if (body.num_times > 0) body.rms_all = std::sqrt(pairs_[i].sum_of_squares / body.num_times);
    }
    return result_;
  }

 private:
  template <class Bodies>
  void match(const Bodies& a, const Bodies& b, bool is_cloth) {
    const auto find = [](const Bodies& bodies, const std::string& name) {
      return std::find_if(bodies.begin(), bodies.end(),
                          [&](const auto& body) { return body.name == name; });
    };
    for (std::size_t i = 0; i < a.size(); ++i) {
      const auto found = find(b, a[i].name);
      if (found == b.end()) {
        result_.only_in_a.push_back(a[i].name);
        continue;
      }
      Pair pair{i, static_cast<std::size_t>(found - b.begin())};
      if constexpr (std::is_same_v<Bodies, std::vector<scenes::Cloth>>) {
        pair.mesh = scenes::make_mesh(a[i]);
        pair.weights = node_weights(pair.mesh);
      }
      pairs_.push_back(std::move(pair));
      BodyDifference body;
      body.name = a[i].name;
      body.is_cloth = is_cloth;
      result_.bodies.push_back(std::move(body));
    }
    for (const auto& body : b) {
      if (find(a, body.name) == a.end()) result_.only_in_b.push_back(body.name);
    }
  }

  void look_at(const scenes::CommonFrame& frame, const scenes::SceneState& a,
               const scenes::SceneState& b) {
    result_.largest_time_gap = std::max(result_.largest_time_gap, std::abs(a.time - b.time));
    const bool is_searching = !result_.first;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      Pair& pair = pairs_[i];
      BodyDifference& body = result_.bodies[i];
      const auto look = [&](const auto& mine, const auto& theirs) {
        const std::optional<Place> place =
            result_.first ? std::nullopt : first_difference(mine, theirs);
        if (place) {
          result_.first = {frame.a, frame.b, a.time, body.name, place->quantity, place->node};
        }
        measure(pair, body, mine, theirs, {frame, a.time});
      };
      if (body.is_cloth) {
        look(a.cloths[pair.a], b.cloths[pair.b]);
      } else {
        look(a.rigids[pair.a], b.rigids[pair.b]);
      }
    }
    if (is_searching && !result_.first && !is_same(a.time, b.time)) {
      result_.first = {frame.a, frame.b, a.time, {}, "time", {}};
    }
  }

  struct Moment {
    scenes::CommonFrame frame;
    double time;  ///< [s]
  };

  static void measure(Pair& pair, BodyDifference& body, const scenes::ClothState& a,
                      const scenes::ClothState& b, const Moment& moment) {
    if (pair.is_apart) return;
    if (!is_same_topology(a, b) || a.positions.cols() != b.positions.cols()) {
      pair.is_apart = true;
      body.note = a.topology || b.topology
                      ? fmt::format("has torn in another way from t = {:.6g} s on", moment.time)
                      : fmt::format("has {} and {} nodes", a.positions.cols(), b.positions.cols());
      return;
    }
    if (a.topology != pair.topology) {
      pair.topology = a.topology;
      pair.weights = node_weights(scenes::drawn_mesh(pair.mesh, a.topology.get()));
    }
    add(pair, body, vertex_distance(a.positions, b.positions, pair.weights), moment);
  }

  static void measure(Pair& pair, BodyDifference& body, const scenes::RigidState& a,
                      const scenes::RigidState& b, const Moment& moment) {
    add(pair, body, vertex_distance(a.position, b.position, VectorX<double>::Ones(1)), moment);
    // The angle between equal orientations is zero but for rounding.
    if (is_same_vector(a.orientation.coeffs(), b.orientation.coeffs())) return;
    const double angle = a.orientation.angularDistance(b.orientation);
    if (angle > body.largest_angle) body.largest_angle = angle;
  }

  static void add(Pair& pair, BodyDifference& body, const VertexDistance& distance,
                  const Moment& moment) {
    if (distance.first_non_finite_node) {
      if (body.note.empty()) {
        body.note = fmt::format("is not finite at t = {:.6g} s, node {}", moment.time,
                                *distance.first_non_finite_node);
      }
      return;
    }
    pair.sum_of_squares += distance.rms * distance.rms;
    if (++body.num_times > 1 && distance.largest <= body.largest) return;
    body.largest = distance.largest;
    body.node = distance.largest_node;
    body.frame_a = moment.frame.a;
    body.frame_b = moment.frame.b;
    body.time = moment.time;
    body.rms = distance.rms;
  }

  const scenes::RecordingReader& a_;
  const scenes::RecordingReader& b_;
  std::vector<Pair> pairs_;  ///< as result_.bodies
  RecordingDifference result_;
};

}  // namespace

bool RecordingDifference::is_equal() const {
  return is_same_precision && is_same_blow_up && !first && only_in_a.empty() && only_in_b.empty() &&
         num_common == num_frames_a && num_common == num_frames_b;
}

const BodyDifference* RecordingDifference::farthest() const {
  const BodyDifference* found = nullptr;
  for (const BodyDifference& body : bodies) {
    if (body.num_times > 0 && (!found || body.largest > found->largest)) found = &body;
  }
  return found;
}

RecordingDifference compare_recordings(const scenes::RecordingReader& a,
                                       const scenes::RecordingReader& b,
                                       const std::function<void(double)>& progress) {
  return Comparison(a, b).run(progress);
}

}  // namespace weft::validation
