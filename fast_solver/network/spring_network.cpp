#include <weft/fast_solver/network/spring_network.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include <weft/custom_forces/law_input.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/fast_solver/network/rest_stiffness.hpp>
#include <weft/mesh/mesh_part.hpp>

namespace weft::fast {
namespace {

struct Entry {
  double rest_length = 0;
  double stiffness = 0;
  double compressed = 0;
  double damping = 0;
  double bending = 0;
};
/// By edge; those of one edge in the order in which they were added.
struct Part {
  std::pair<int, int> nodes;  ///< the lower one first
  int number;
  Entry entry;

  [[nodiscard]] bool operator<(const Part& other) const {
    return nodes != other.nodes ? nodes < other.nodes : number < other.number;
  }
};
using Parts = std::vector<Part>;

void add_part(int a, int b, const Entry& entry, Parts& parts) {
  parts.push_back({std::minmax(a, b), static_cast<int>(parts.size()), entry});
}

void add_springs(const forces::LawSpecification& law, const ClothMesh& mesh, Parts& parts) {
  const Edges edges = forces::law_edges(law, mesh);
  const VectorX<double> lengths = forces::law_rest_lengths(law, mesh, edges);
  const bool is_tension = forces::role_of(law.law) == forces::LawRole::kSpring;
  const double stiffness = is_tension ? forces::law_scalar(law, "stiffness") : 0.0;
  const double ratio = is_tension ? forces::law_scalar(law, "compression_ratio") : 1.0;
  const double damping = is_tension ? 0.0 : forces::law_scalar(law, "damping");
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    add_part(edges(0, e), edges(1, e), {lengths[e], stiffness, ratio * stiffness, damping, 0},
             parts);
  }
}

/// One for each edge, ascending. The last spring's rest length counts.
Parts sum_up(Parts parts) {
  std::sort(parts.begin(), parts.end());
  std::size_t count = 0;
  for (const Part& part : parts) {
    if (count == 0 || parts[count - 1].nodes != part.nodes) {
      parts[count++] = part;
      continue;
    }
    Entry& sum = parts[count - 1].entry;
    if (part.entry.rest_length > 0) sum.rest_length = part.entry.rest_length;
    sum.stiffness += part.entry.stiffness;
    sum.compressed += part.entry.compressed;
    sum.damping += part.entry.damping;
    sum.bending += part.entry.bending;
  }
  parts.resize(count);
  return parts;
}

}  // namespace

bool is_bending(std::string_view law) {
  return forces::role_of(law) == forces::LawRole::kBending;
}

bool is_implicit(const forces::LawSpecification& law) {
  const forces::LawRole role = forces::role_of(law.law);
  return role == forces::LawRole::kSpring || role == forces::LawRole::kSpringDamper;
}

SpringNetwork make_network(const ClothMesh& mesh,
                           const std::vector<forces::LawSpecification>& laws) {
  Parts entries;
  std::vector<forces::LawSpecification> bending;
  for (const forces::LawSpecification& given : laws) {
    const forces::LawSpecification law = forces::checked(given);
    if (is_implicit(law)) add_springs(law, mesh, entries);
    if (is_bending(law.law)) bending.push_back(law);
  }
  for (const MatrixPart& part : rest_stiffness(mesh, bending)) {
    add_part(part.row, part.column, {0, 0, 0, 0, -part.value}, entries);
  }
  entries = sum_up(std::move(entries));
  for (auto& [nodes, number, entry] : entries) {
    if (entry.rest_length > 0) continue;
    const double distance =
        (mesh.rest_positions.col(nodes.first) - mesh.rest_positions.col(nodes.second)).norm();
    entry.rest_length =
        distance > 0 ? distance : 1.0;  // of no spring, but a length to compare with
  }
  SpringNetwork network;
  const auto m = static_cast<Eigen::Index>(entries.size());
  network.edges.resize(2, m);
  for (auto* values : {&network.rest_lengths, &network.stiffness, &network.compressed_stiffness,
                       &network.damping, &network.bending}) {
    values->resize(m);
  }
  Eigen::Index e = 0;
  for (const auto& [nodes, number, entry] : entries) {
    network.edges.col(e) << nodes.first, nodes.second;
    network.rest_lengths[e] = entry.rest_length;
    network.stiffness[e] = entry.stiffness;
    network.compressed_stiffness[e] = entry.compressed;
    network.damping[e] = entry.damping;
    network.bending[e] = entry.bending;
    ++e;
  }
  return network;
}

namespace {

bool is_marked(const std::vector<char>& flags, int node) {
  return flags[static_cast<std::size_t>(node)] != 0;
}

void resize(Eigen::Index num_springs, SpringNetwork& network) {
  network.edges.resize(2, num_springs);
  for (auto* values : {&network.rest_lengths, &network.stiffness, &network.compressed_stiffness,
                       &network.damping, &network.bending}) {
    values->resize(num_springs);
  }
}

void copy_springs(const SpringNetwork& from, Eigen::Index first, Eigen::Index count,
                  Eigen::Index to, SpringNetwork& network) {
  network.edges.middleCols(to, count) = from.edges.middleCols(first, count);
  for (auto values :
       {&SpringNetwork::rest_lengths, &SpringNetwork::stiffness,
        &SpringNetwork::compressed_stiffness, &SpringNetwork::damping, &SpringNetwork::bending}) {
    (network.*values).segment(to, count) = (from.*values).segment(first, count);
  }
}

}  // namespace

SpringNetwork make_network_at(const std::vector<char>& is_wanted, const ClothMesh& mesh,
                              const std::vector<forces::LawSpecification>& laws) {
  const MeshPart part = part_around(mesh, is_wanted);
  const SpringNetwork of_part = make_network(part.mesh, laws);
  SpringNetwork network;
  resize(of_part.edges.cols(), network);
  Eigen::Index count = 0;
  for (Eigen::Index e = 0; e < of_part.edges.cols(); ++e) {
    const int a = part.nodes[static_cast<std::size_t>(of_part.edges(0, e))];
    const int b = part.nodes[static_cast<std::size_t>(of_part.edges(1, e))];
    if (!is_marked(is_wanted, a) && !is_marked(is_wanted, b)) continue;
    copy_springs(of_part, e, 1, count, network);
    network.edges.col(count++) << a, b;
  }
  SpringNetwork result;
  resize(count, result);
  copy_springs(network, 0, count, 0, result);
  return result;
}

void replace_springs(const std::vector<char>& is_changed, const SpringNetwork& springs,
                     SpringNetwork& network) {
  const auto is_old = [&](Eigen::Index e) {
    const int a = network.edges(0, e);
    const int b = network.edges(1, e);
    return is_marked(is_changed, a) || is_marked(is_changed, b);
  };
  Eigen::Index num_old = 0;
  for (Eigen::Index e = 0; e < network.edges.cols(); ++e) num_old += is_old(e) ? 1 : 0;
  SpringNetwork result;
  resize(network.edges.cols() - num_old + springs.edges.cols(), result);
  const auto key = [](const SpringNetwork& of, Eigen::Index e) {
    return std::pair(of.edges(0, e), of.edges(1, e));
  };
  Eigen::Index to = 0;
  Eigen::Index next = 0;  // of springs
  for (Eigen::Index e = 0; e < network.edges.cols();) {
    if (is_old(e)) {
      ++e;
      continue;
    }
    for (; next < springs.edges.cols() && key(springs, next) < key(network, e); ++next) {
      copy_springs(springs, next, 1, to++, result);
    }
    // As far as nothing comes between.
    Eigen::Index end = e + 1;
    while (end < network.edges.cols() && !is_old(end) &&
           (next == springs.edges.cols() || key(network, end) < key(springs, next))) {
      ++end;
    }
    copy_springs(network, e, end - e, to, result);
    to += end - e;
    e = end;
  }
  copy_springs(springs, next, springs.edges.cols() - next, to, result);
  network = std::move(result);
}

void set_rest_length(int first, int second, double rest_length, SpringNetwork& network) {
  const std::pair<int, int> nodes = std::minmax(first, second);
  const auto nodes_of = [&](Eigen::Index e) {
    return std::pair(network.edges(0, e), network.edges(1, e));
  };
  Eigen::Index low = 0;
  for (Eigen::Index high = network.edges.cols(); low < high;) {
    const Eigen::Index middle = low + (high - low) / 2;
    if (nodes_of(middle) < nodes) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  if (low < network.edges.cols() && nodes_of(low) == nodes) network.rest_lengths[low] = rest_length;
}

}  // namespace weft::fast
