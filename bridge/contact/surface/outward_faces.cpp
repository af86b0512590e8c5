#include <weft/bridge/contact/surface/outward_faces.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// A face at an edge, and whether it runs along it from the lower node to the higher one.
struct Side {
  int face;
  bool ascends;
};

/// The faces at each edge; nothing if an edge has not two of them.
std::map<std::pair<int, int>, std::vector<Side>> sides_of(const btSoftBody& body) {
  std::map<std::pair<int, int>, std::vector<Side>> sides;
  for (int f = 0; f < body.m_faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto from = static_cast<int>(body.m_faces[f].m_n[k] - &body.m_nodes[0]);
      const auto to = static_cast<int>(body.m_faces[f].m_n[(k + 1) % 3] - &body.m_nodes[0]);
      sides[std::minmax(from, to)].push_back({f, from < to});
    }
  }
  for (const auto& [edge, of_edge] : sides) {
    if (of_edge.size() != 2) return {};
  }
  return sides;
}

/// Six times the volume that a face and the first node enclose [m^3].
double volume_below(const btSoftBody& body, int face) {
  const auto& n = body.m_faces[face].m_n;
  const btVector3& origin = body.m_nodes[0].m_x;
  return static_cast<double>(
      btDot(n[0]->m_x - origin, btCross(n[1]->m_x - origin, n[2]->m_x - origin)));
}

}  // namespace

std::vector<signed char> outward_faces(const btSoftBody& body) {
  const auto sides = sides_of(body);
  if (sides.empty()) return {};
  // By the winding of the first face, from neighbor to neighbor.
  std::vector<signed char> signs(static_cast<std::size_t>(body.m_faces.size()), 0);
  std::vector<int> pending{0};
  signs[0] = 1;
  std::size_t num_reached = 0;
  double volume = 0;
  while (!pending.empty()) {
    const int face = pending.back();
    pending.pop_back();
    ++num_reached;
    const signed char sign = signs[static_cast<std::size_t>(face)];
    volume += sign * volume_below(body, face);
    for (int k = 0; k < 3; ++k) {
      const auto from = static_cast<int>(body.m_faces[face].m_n[k] - &body.m_nodes[0]);
      const auto to = static_cast<int>(body.m_faces[face].m_n[(k + 1) % 3] - &body.m_nodes[0]);
      const std::vector<Side>& pair = sides.at(std::minmax(from, to));
      const Side& other = pair[0].face == face ? pair[1] : pair[0];
      const auto wanted =
          static_cast<signed char>(pair[0].ascends != pair[1].ascends ? sign : -sign);
      signed char& known = signs[static_cast<std::size_t>(other.face)];
      if (known == -wanted) return {};  // a surface of one side
      if (known != 0) continue;
      known = wanted;
      pending.push_back(other.face);
    }
  }
  if (num_reached != signs.size() || volume == 0) return {};
  if (volume < 0) {
    for (signed char& sign : signs) sign = static_cast<signed char>(-sign);
  }
  return signs;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
