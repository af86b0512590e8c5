#include <weft/bridge/contact/unfolded_windows.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/contact/surface/convex_outline.hpp>
#include <weft/core/index.hpp>
#include <weft/core/types.hpp>

#include <Eigen/Eigenvalues>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Faces of a block, about. Smaller ones are unfolded where cloth curves more, and are more boxes to compare.
constexpr double kFacesOfBlock = 128;
/// A region whose faces have another area than the convex region there, by more than this share, has holes or notches, or faces on
/// each other [-].
constexpr double kSameArea = 1e-6;
/// An edge that is so near to the outline is on it, over its length [-].
constexpr double kOnOutline = 1e-3;
/// Few faces that are far from each other get no more blocks along an axis than faces over this.
constexpr int kFewestFaces = 8;

std::array<int, 3> corners_of(const btSoftBody& body, int face) {
  std::array<int, 3> corners{};
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = static_cast<int>(body.m_faces[face].m_n[k] - &body.m_nodes[0]);
  return corners;
}

/// The places of nodes on the plane that is nearest to all, along and across the longest side of their convex hull [m].
std::vector<PlanePoint> map_of(const btSoftBody& body) {
  const int count = body.m_nodes.size();
  Matrix3X<double> places(3, count);
  for (int i = 0; i < count; ++i) places.col(i) = from_bullet<double>(body.m_nodes[i].m_x);
  places.colwise() -= places.rowwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Matrix3<double>> axes(places * places.transpose());
  const Eigen::Matrix<double, 2, 3> plane = axes.eigenvectors().rightCols<2>().transpose();
  std::vector<PlanePoint> map(at(count));
  for (int i = 0; i < count; ++i) map[at(i)] = plane * places.col(i);
  const Polygon hull = convex_hull(map);
  PlanePoint along(0, 0);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const PlanePoint side = hull[(i + 1) % hull.size()] - hull[i];
    if (side.squaredNorm() > along.squaredNorm()) along = side;
  }
  if (!(along.norm() > 0)) return map;
  along.normalize();
  for (PlanePoint& point : map)
    point = {along.dot(point), along.x() * point.y() - along.y() * point.x()};
  return map;
}

/// The boxes of edges that do not join two faces, and are not on the outline: slits, seams, holes and notches, pieces on each other.
std::vector<PlaneBox> gaps_in(const std::vector<std::array<int, 3>>& faces,
                              const std::vector<PlanePoint>& map, const Polygon& outline) {
  std::map<std::array<int, 2>, int> num_faces;
  for (const auto& n : faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(n[k], n[(k + 1) % 3]);
      ++num_faces[{low, high}];
    }
  }
  std::vector<PlaneBox> gaps;
  for (const auto& [edge, count] : num_faces) {
    if (count == 2) continue;
    const PlanePoint& a = map[at(edge[0])];
    const PlanePoint& b = map[at(edge[1])];
    const double most = kOnOutline * (b - a).norm();
    bool is_on_outline = false;
    for (std::size_t i = 0; i < outline.size() && count == 1 && !is_on_outline; ++i) {
      const PlanePoint& from = outline[i];
      const PlanePoint& to = outline[(i + 1) % outline.size()];
      const double length = (to - from).norm();
      is_on_outline =
          std::max(std::abs(turn(from, to, a)), std::abs(turn(from, to, b))) <= most * length;
    }
    if (is_on_outline) continue;
    gaps.push_back({a, a});
    gaps.back().include(b);
  }
  return gaps;
}

PlaneBox around(const std::array<int, 3>& corners, const std::vector<PlanePoint>& map) {
  PlaneBox box{map[at(corners[0])], map[at(corners[0])]};
  box.include(map[at(corners[1])]);
  box.include(map[at(corners[2])]);
  return box;
}

}  // namespace

/// use(block) for those of a window.
template <class Use>
void UnfoldedWindows::for_blocks(int window, const Use& use) const {
  const int x = window % num_windows(0);
  const int y = window / num_windows(0);
  for (int j = y; j < std::min(y + 2, num_blocks_[1]); ++j) {
    for (int i = x; i < std::min(x + 2, num_blocks_[0]); ++i) use(at(j * num_blocks_[0] + i));
  }
}

void UnfoldedWindows::find(const btSoftBody& body) {
  windows_.clear();
  const int num_faces = body.m_faces.size();
  if (num_faces == 0) return;
  const std::vector<PlanePoint> map = map_of(body);
  std::vector<std::array<int, 3>> faces(at(num_faces));
  PlaneBox all = around(corners_of(body, 0), map);
  std::vector<PlanePoint> corners;
  for (int f = 0; f < num_faces; ++f) {
    faces[at(f)] = corners_of(body, f);
    const PlaneBox box = around(faces[at(f)], map);
    all.include(box.low);
    all.include(box.high);
    Polygon polygon;
    for (const int node : faces[at(f)]) polygon.push_back(map[at(node)]);
    corners.insert(corners.end(), polygon.begin(), polygon.end());
    if (!(area(polygon) > 0)) return;  // it stands on the plane
  }
  const Polygon hull = convex_hull(corners);
  const PlanePoint size = all.high - all.low;
  const double side = std::sqrt(size.x() * size.y() * kFacesOfBlock / num_faces);
  const double most = std::max(1, num_faces / kFewestFaces);
  for (int k = 0; k < 2; ++k)
    num_blocks_[at(k)] = static_cast<int>(std::lround(std::clamp(size[k] / side, 1.0, most)));
  make_blocks(faces, map, all);

  find_whole_windows(map, hull, gaps_in(faces, map, hull));
  const bool is_any = std::any_of(windows_.begin(), windows_.end(),
                                  [](const Window& window) { return window.is_whole; });
  if (!is_any) windows_.clear();
}

void UnfoldedWindows::find_whole_windows(const std::vector<PlanePoint>& map, const Polygon& hull,
                                         const std::vector<PlaneBox>& gaps) {
  std::vector<PlaneBox> boxes;  // of blocks
  for (const Block& block : blocks_) {
    boxes.push_back(PlaneBox::nowhere());
    for (const int node : block.nodes) boxes.back().include(map[at(node)]);
  }
  windows_.assign(at(num_windows(0) * num_windows(1)), {});
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    std::vector<char> is_mine(blocks_.size(), 0);
    PlaneBox box = PlaneBox::nowhere();
    for_blocks(static_cast<int>(w), [&](std::size_t b) {
      is_mine[b] = 1;
      if (blocks_[b].num_faces == 0) return;
      box.include(boxes[b].low);
      box.include(boxes[b].high);
    });
    const bool has_gaps =
        std::any_of(gaps.begin(), gaps.end(), [&](const PlaneBox& gap) { return gap.meets(box); });
    if (has_gaps) continue;
    double covered = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (!boxes[b].meets(box)) continue;
      for (std::size_t i = blocks_[b].first; i < blocks_[b].first + blocks_[b].num_faces; ++i) {
        const PlaneBox face = around(faces_.corners[i], map);
        if (!face.meets(box)) continue;
        Polygon polygon;
        for (const int node : faces_.corners[i]) polygon.push_back(map[at(node)]);
        const double part = area(box.contains(face) ? polygon : clipped(polygon, box));
        covered += part;
        if (is_mine[b] == 0 && part > 0) windows_[w].others.push_back(i);
      }
    }
    const double wanted = area(clipped(hull, box));
    windows_[w].is_whole = std::abs(covered - wanted) <= kSameArea * wanted;
  }
}

void UnfoldedWindows::make_blocks(const std::vector<std::array<int, 3>>& faces,
                                  const std::vector<PlanePoint>& map, const PlaneBox& all) {
  std::vector<std::vector<std::size_t>> faces_of(at(num_blocks_[0] * num_blocks_[1]));
  block_of_.resize(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto& n = faces[f];
    const PlanePoint middle = (map[at(n[0])] + map[at(n[1])] + map[at(n[2])]) / 3;
    std::array<int, 2> place{};
    for (int k = 0; k < 2; ++k) {
      const double share = (middle[k] - all.low[k]) / (all.high[k] - all.low[k]);
      place[at(k)] =
          std::clamp(static_cast<int>(share * num_blocks_[at(k)]), 0, num_blocks_[at(k)] - 1);
    }
    block_of_[f] = place[1] * num_blocks_[0] + place[0];
    faces_of[at(block_of_[f])].push_back(f);
  }
  faces_ = {};
  blocks_.assign(faces_of.size(), {});
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Block& block = blocks_[b];
    block.first = faces_.corners.size();
    block.num_faces = faces_of[b].size();
    while (!faces_of[b].empty() && faces_of[b].size() % kLanes != 0)
      faces_of[b].push_back(faces_of[b].back());
    for (const std::size_t f : faces_of[b]) {
      const auto& n = faces[f];
      faces_.corners.push_back(n);
      block.nodes.insert(block.nodes.end(), n.begin(), n.end());
      Eigen::Matrix2d edges;
      edges << map[at(n[1])] - map[at(n[0])], map[at(n[2])] - map[at(n[0])];
      const Eigen::Matrix2d inverse = edges.inverse();
      for (int k = 0; k < 4; ++k)
        faces_.inverses[at(k)].push_back(static_cast<btScalar>(inverse(k / 2, k % 2)));
    }
    block.last = faces_.corners.size();
    std::sort(block.nodes.begin(), block.nodes.end());
    block.nodes.erase(std::unique(block.nodes.begin(), block.nodes.end()), block.nodes.end());
  }
}

void UnfoldedWindows::refit(Ways ways, const btVector3& motion, btScalar reach) {
  are_all_apart_ = false;
  if (windows_.empty()) return;
  find_gradients(ways);
  for (std::size_t w = 0; w < windows_.size(); ++w)
    windows_[w].is_unfolded = is_unfolded(static_cast<int>(w));
  for (Block& block : blocks_) {
    block.box = MotionBox::nowhere();
    for (const int node : block.nodes)
      block.box.include(MotionBox::of(ways[at(node)][0] + motion, ways[at(node)][1]));
  }
  find_meetings(reach);
}

// F = (b - a, c - a) D, with D the inverse of these edges on the map.
void UnfoldedWindows::find_gradients(Ways ways) {
  for (Block& block : blocks_) block.directions = {btVector3(0, 0, 0), btVector3(0, 0, 0)};
  for (std::size_t end = 0; end < 2; ++end) {
    Gradients& gradients = gradients_[end];
    for (std::vector<btScalar>& numbers : gradients) numbers.resize(faces_.corners.size());
    for (Block& block : blocks_) {
      for (std::size_t i = block.first; i < block.last; ++i) {
        const auto& n = faces_.corners[i];
        const btVector3& a = ways[at(n[0])][end];
        const btVector3 ab = ways[at(n[1])][end] - a;
        const btVector3 ac = ways[at(n[2])][end] - a;
        const btVector3 first = faces_.inverses[0][i] * ab + faces_.inverses[2][i] * ac;
        const btVector3 second = faces_.inverses[1][i] * ab + faces_.inverses[3][i] * ac;
        for (int k = 0; k < 3; ++k) {
          gradients[at(k)][i] = first[k];
          gradients[at(k + 3)][i] = second[k];
        }
        block.directions[0] += first;
        block.directions[1] += second;
      }
    }
  }
}

bool UnfoldedWindows::is_unfolded(int window) const {
  const Window& one = windows_[at(window)];
  if (!one.is_whole) return false;
  btVector3 first(0, 0, 0);
  btVector3 second(0, 0, 0);
  for_blocks(window, [&](std::size_t b) {
    first += blocks_[b].directions[0];
    second += blocks_[b].directions[1];
  });
  // The sum and the difference of unit vectors are square to each other.
  const btVector3 sum = unit(unit(first) + unit(second));
  const btVector3 difference = unit(unit(first) - unit(second));
  const Frame frame{SIMDSQRT12 * (sum + difference), SIMDSQRT12 * (sum - difference)};
  bool is_unfolded = true;
  for_blocks(window, [&](std::size_t b) {
    is_unfolded = is_unfolded && are_unfolded(blocks_[b].first, blocks_[b].last, frame);
  });
  for (const std::size_t i : one.others) is_unfolded = is_unfolded && num_folded<1>(i, frame) == 0;
  return is_unfolded;
}

bool UnfoldedWindows::are_unfolded(std::size_t first, std::size_t last, const Frame& frame) const {
  int sum = 0;
  for (std::size_t i = first; i < last && sum == 0; i += kLanes) sum = num_folded<kLanes>(i, frame);
  return sum == 0;
}

// The least eigenvalue of a symmetric matrix of two rows is larger than m if its trace and determinant are positive without m. Folded
// too is what is no number.
template <std::size_t kCount>
int UnfoldedWindows::num_folded(std::size_t first, const Frame& frame) const {
  std::array<int, kCount> is_folded{};
  for (const Gradients& f : gradients_) {
    for (std::size_t k = 0; k < kCount; ++k) {
      const auto along = [&](const btVector3& axis, std::size_t column) {
        return axis.x() * f[column][first + k] + axis.y() * f[column + 1][first + k] +
               axis.z() * f[column + 2][first + k];
      };
      const btScalar a = along(frame[0], 0) - kLeast;
      const btScalar d = along(frame[1], 3) - kLeast;
      const btScalar b = (along(frame[0], 3) + along(frame[1], 0)) / 2;
      is_folded[k] |= static_cast<int>(!(a > 0)) | static_cast<int>(!(a * d > b * b));
    }
  }
  return std::accumulate(is_folded.begin(), is_folded.end(), 0);
}

bool UnfoldedWindows::share_window(int one, int other) const {
  std::array<int, 2> low{};
  std::array<int, 2> high{};
  const std::array<int, 2> a{one % num_blocks_[0], one / num_blocks_[0]};
  const std::array<int, 2> b{other % num_blocks_[0], other / num_blocks_[0]};
  for (std::size_t k = 0; k < 2; ++k) {
    low[k] = std::max(0, std::max(a[k], b[k]) - 1);
    high[k] = std::min(std::min(a[k], b[k]), num_windows(static_cast<int>(k)) - 1);
  }
  for (int j = low[1]; j <= high[1]; ++j) {
    for (int i = low[0]; i <= high[0]; ++i) {
      if (windows_[at(j * num_windows(0) + i)].is_unfolded) return true;
    }
  }
  return false;
}

// Sorted along the longest extent of the surface, for there may be thousands.
void UnfoldedWindows::find_meetings(btScalar reach) {
  may_meet_.assign(blocks_.size(), 0);
  MotionBox all = MotionBox::nowhere();
  for (const Block& block : blocks_) all.include(block.box);
  std::size_t axis = 0;
  bool is_finite = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const btScalar extent = all.high[k] - all.low[k];
    if (extent > all.high[axis] - all.low[axis]) axis = k;
    is_finite = is_finite && extent >= 0 && extent < std::numeric_limits<btScalar>::max();
  }
  if (!is_finite) return may_meet_.assign(blocks_.size(), 1);  // the body has exploded
  order_.resize(blocks_.size());
  std::iota(order_.begin(), order_.end(), 0);
  const auto low = [&](int b) { return blocks_[at(b)].box.low[axis]; };
  std::sort(order_.begin(), order_.end(),
            [&](int a, int b) { return low(a) != low(b) ? low(a) < low(b) : a < b; });
  for (std::size_t o = 0; o < order_.size(); ++o) {
    const int one = order_[o];
    const MotionBox box = blocks_[at(one)].box.grown(reach);
    for (std::size_t p = o; p < order_.size() && !(low(order_[p]) > box.high[axis]); ++p) {
      const int other = order_[p];
      if (!meet(box, blocks_[at(other)].box) || share_window(one, other)) continue;
      may_meet_[at(one)] = may_meet_[at(other)] = 1;
    }
  }
  are_all_apart_ =
      std::none_of(may_meet_.begin(), may_meet_.end(), [](char is) { return is != 0; });
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
