#include <weft/reference/contact/self_contacts.hpp>

#include <algorithm>
#include <set>

#include <Eigen/Geometry>

namespace weft::reference {
namespace {

FourPoints gathered(const Matrix3X<double>& all, const std::array<int, 4>& nodes) {
  FourPoints four;
  for (int k = 0; k < 4; ++k) four.col(k) = all.col(nodes[static_cast<std::size_t>(k)]);
  return four;
}

/// What an element sweeps over.
struct Swept {
  Eigen::AlignedBox3d box;
  int index;
};

template <class Elements>
std::vector<Swept> swept(const Elements& elements, const Matrix3X<double>& start,
                         const Matrix3X<double>& end, double margin) {
  std::vector<Swept> boxes;
  boxes.reserve(elements.size());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    Swept one{{}, static_cast<int>(e)};
    for (const int node : elements[e]) {
      one.box.extend(Vector3<double>(start.col(node)));
      one.box.extend(Vector3<double>(end.col(node)));
    }
    one.box.min().array() -= margin;
    one.box.max().array() += margin;
    boxes.push_back(one);
  }
  std::sort(boxes.begin(), boxes.end(), [](const Swept& a, const Swept& b) {
    return std::pair(a.box.min().x(), a.index) < std::pair(b.box.min().x(), b.index);
  });
  return boxes;
}

/// Calls found(a, b) for elements of two sorted lists whose boxes overlap, in a fixed order.
template <class Found>
void overlaps(const std::vector<Swept>& first, const std::vector<Swept>& second,
              const Found& found) {
  double widest = 0.0;
  for (const Swept& one : second) widest = std::max(widest, one.box.sizes().x());
  for (const Swept& a : first) {
    auto b = std::lower_bound(second.begin(), second.end(), a.box.min().x() - widest,
                              [](const Swept& one, double x) { return one.box.min().x() < x; });
    for (; b != second.end() && b->box.min().x() <= a.box.max().x(); ++b) {
      if (a.box.intersects(b->box)) found(a.index, b->index);
    }
  }
}

/// What a pair may come down to on its way, where layers keep a gap [m].
double closest_allowed(double part, double at_start, double gap) {
  return part * std::min(at_start, gap);
}

}  // namespace

SelfContacts::SelfContacts(const System& system) {
  for (std::size_t b = 0; b < system.bodies.size(); ++b) {
    const Body& body = system.bodies[b];
    meets_itself_.push_back(body.self_contact);
    meets_others_.push_back(body.mutual_contact);
    if (!body.self_contact && !body.mutual_contact) continue;
    largest_thickness_ = std::max(largest_thickness_, body.self_thickness);
    const int first = static_cast<int>(nodes_.size());
    for (int node = 0; node < body.mesh.num_nodes(); ++node) nodes_.push_back({b, node});
    std::set<std::array<int, 2>> edges;
    for (Eigen::Index t = 0; t < body.mesh.triangles.cols(); ++t) {
      const auto corners = body.mesh.triangles.col(t).array() + first;
      triangles_.push_back({corners[0], corners[1], corners[2]});
      for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax({int(corners[k]), int(corners[(k + 1) % 3])});
        edges.insert({low, high});
      }
    }
    edges_.insert(edges_.end(), edges.begin(), edges.end());
  }
  budget_ = search_budget(nodes_.size() + edges_.size() + triangles_.size());
}

bool SelfContacts::may_meet(int first, int second) const {
  const std::size_t a = nodes_[static_cast<std::size_t>(first)].body;
  const std::size_t b = nodes_[static_cast<std::size_t>(second)].body;
  return a == b ? meets_itself_[a] : meets_others_[a] && meets_others_[b];
}

std::vector<SelfContacts::Candidate> SelfContacts::candidates(const Matrix3X<double>& start,
                                                              const Matrix3X<double>& end) {
  const double margin = 0.5 * largest_thickness_;
  std::vector<std::array<int, 1>> points(nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) points[n] = {static_cast<int>(n)};
  std::vector<Candidate> found;
  std::int64_t num_found = 0;
  const auto keep = [&](const Candidate& candidate) {
    if (++num_found <= budget_.pairs) found.push_back(candidate);
  };
  overlaps(swept(points, start, end, margin), swept(triangles_, start, end, margin),
           [&](int node, int triangle) {
             const auto& corners = triangles_[static_cast<std::size_t>(triangle)];
             if (std::find(corners.begin(), corners.end(), node) != corners.end()) return;
             if (!may_meet(node, corners[0])) return;
             keep({PairKind::kPointTriangle, {node, corners[0], corners[1], corners[2]}});
           });
  const std::vector<Swept> edges = swept(edges_, start, end, margin);
  overlaps(edges, edges, [&](int first, int second) {
    if (first >= second) return;
    const auto& a = edges_[static_cast<std::size_t>(first)];
    const auto& b = edges_[static_cast<std::size_t>(second)];
    if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) return;
    if (!may_meet(a[0], b[0])) return;
    keep({PairKind::kEdges, {a[0], a[1], b[0], b[1]}});
  });
  spend("found", num_found, "candidate pairs", budget_.pairs);
  if (exhausted_) found.clear();
  return found;
}

void SelfContacts::spend(const char* what, std::int64_t count, const char* unit,
                         std::int64_t budget) {
  if (count <= budget || exhausted_) return;
  exhausted_ = Exhausted{nodes_.front().body, over_budget(what, count, unit, budget)};
}

void SelfContacts::count_visits(std::int64_t visits) {
  num_visits_ += visits;
  spend("visited", num_visits_, "contacts", budget_.visits);
}

double SelfContacts::gap(const System& system, const Candidate& candidate) const {
  const Node& first = nodes_[static_cast<std::size_t>(candidate.nodes[0])];
  const Node& last = nodes_[static_cast<std::size_t>(candidate.nodes[3])];
  const Body& a = system.bodies[first.body];
  const double thickness = 0.5 * (a.self_thickness + system.bodies[last.body].self_thickness);
  if (first.body != last.body) return thickness;
  FourPoints rest;
  for (int k = 0; k < 4; ++k) {
    const auto number = static_cast<std::size_t>(candidate.nodes[static_cast<std::size_t>(k)]);
    rest.col(k) = a.mesh.rest_positions.col(nodes_[number].node);
  }
  // Neighbors in the same layer would push each other apart for ever.
  return std::min(thickness, 0.5 * nearest(candidate.kind, rest).distance());
}

Matrix3X<double> SelfContacts::positions(const System& system) const {
  Matrix3X<double> all(3, static_cast<Eigen::Index>(nodes_.size()));
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    all.col(static_cast<Eigen::Index>(n)) =
        system.bodies[nodes_[n].body].positions.col(nodes_[n].node);
  }
  return all;
}

bool SelfContacts::update(const System& system, const SystemStep& step, bool friction,
                          ContactPoints& points, ContactProblem& problem) {
  const Matrix3X<double> start = positions(system);
  Matrix3X<double> motion(3, start.cols());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const auto& [body, node] = nodes_[n];
    motion.col(static_cast<Eigen::Index>(n)) =
        step.time_step * points.velocity(body, node, step.bodies[body].mean_velocities, problem);
  }
  bool changed = false;
  for (const Candidate& candidate : candidates(start, start + motion)) {
    spend("took", num_distances_, "distances of pairs", budget_.distances);
    if (exhausted_) return false;
    const FourPoints from = gathered(start, candidate.nodes);
    const FourPoints way = gathered(motion, candidate.nodes);
    const Nearest before = nearest(candidate.kind, from);
    const double at_start = before.distance();
    num_distances_ += 3;              // at the start, at the end and at rest
    if (!(at_start > 0.0)) continue;  // no side to keep to
    const double kept = gap(system, candidate);
    // Layers that begin too near part over a few steps, not in one.
    const double wanted = at_start >= kept ? kept : std::min(kept, at_start + 0.25 * kept);
    const bool ends_near =
        nearest(candidate.kind, from + way).distance() < wanted - kGapTolerance * kept;
    const auto hit = first_approach(candidate.kind, from, way,
                                    closest_allowed(kNearestPart, at_start, kept), &num_distances_);
    if (!ends_near && !hit) continue;
    Nearest place = before;
    if (hit) place = nearest(candidate.kind, from + *hit * way);
    if (!(place.distance() > 0.0)) place = before;
    const Vector3<double> normal = place.separation / place.distance();
    double now = 0.0, next = 0.0;  // separation along the normal at both ends of the step
    for (int k = 0; k < 4; ++k) {
      const double weight = place.weights[static_cast<std::size_t>(k)];
      now += weight * normal.dot(from.col(k));
      next += weight * normal.dot(from.col(k) + way.col(k));
    }
    if (next >= wanted - kGapTolerance * kept) continue;  // already held by its linearisation
    Contact contact{.normal = normal, .target_speed = (wanted - now) / step.time_step};
    PairTouch touch{.weights = place.weights, .normal = normal};
    double inverse_mass = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& [body, node] = nodes_[static_cast<std::size_t>(candidate.nodes[k])];
      touch.bodies[k] = body;
      touch.nodes[k] = node;
      contact.on.points[k] =
          points.point(body, node, step.bodies[body].mean_velocities.col(node), problem);
      contact.on.weights[k] = place.weights[k];
      inverse_mass += place.weights[k] * place.weights[k] * step.inverse_masses[body][node];
    }
    if (!(inverse_mass > 0.0)) continue;
    touch.friction =
        friction ? system.bodies[touch.bodies[0]].friction * system.bodies[touch.bodies[3]].friction
                 : 0.0;
    contact.friction = touch.friction;
    entries_.push_back({problem.contacts.size(), touch});
    problem.contacts.push_back(contact);
    changed = true;
  }
  return changed;
}

void SelfContacts::collect(const ContactProblem& problem, std::vector<PairTouch>& touches) const {
  for (const Entry& entry : entries_) {
    if (!problem.contacts[entry.contact].impulse.isZero(0.0)) touches.push_back(entry.touch);
  }
}

int SelfContacts::stop_crossings(const System& system, SystemStep& step) {
  const Matrix3X<double> start = positions(system);
  std::set<int> stopped;
  for (;;) {
    Matrix3X<double> motion(3, start.cols());
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const auto& [body, node] = nodes_[n];
      motion.col(static_cast<Eigen::Index>(n)) =
          step.time_step * step.bodies[body].mean_velocities.col(node);
    }
    const std::size_t before = stopped.size();
    for (const Candidate& candidate : candidates(start, start + motion)) {
      spend("took", num_distances_, "distances of pairs", budget_.distances);
      if (exhausted_) return static_cast<int>(stopped.size());
      const FourPoints from = gathered(start, candidate.nodes);
      const double at_start = nearest(candidate.kind, from).distance();
      num_distances_ += 2;  // at the start and at rest
      if (!(at_start > 0.0)) continue;
      const double allowed = closest_allowed(kStopPart, at_start, gap(system, candidate));
      if (!first_approach(candidate.kind, from, gathered(motion, candidate.nodes), allowed,
                          &num_distances_)) {
        continue;
      }
      for (const int number : candidate.nodes) {
        const auto& [body, node] = nodes_[static_cast<std::size_t>(number)];
        if (step.inverse_masses[body][node] > 0.0) stopped.insert(number);
      }
    }
    if (stopped.size() == before) return static_cast<int>(stopped.size());
    for (const int number : stopped) {
      const auto& [body, node] = nodes_[static_cast<std::size_t>(number)];
      step.bodies[body].mean_velocities.col(node).setZero();
      step.bodies[body].end_velocities.col(node).setZero();
    }
  }
}

}  // namespace weft::reference
