#include <weft/bridge/contact/face_tree.hpp>

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <utility>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Faces whose sine between two edges is less are too thin for weights.
constexpr btScalar kThin = btScalar(0.01);
constexpr btScalar kFar = std::numeric_limits<btScalar>::max();

/// Divides elements into groups of about equal size: halves them at the median of their centers along the longest
/// extent of these, as often as necessary. ends gets the end of each group.
void divide(const std::vector<btVector3>& centers, std::vector<int>& order, std::size_t first,
            std::size_t last, std::size_t num_groups, std::vector<std::size_t>& ends) {
  if (num_groups == 1) {
    ends.push_back(last);
    return;
  }
  const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
  btVector3 low(kFar, kFar, kFar);
  btVector3 high = -low;
  for (std::size_t i = first; i < last; ++i) {
    low.setMin(centers[static_cast<std::size_t>(order[i])]);
    high.setMax(centers[static_cast<std::size_t>(order[i])]);
  }
  const int axis = (high - low).maxAxis();
  const std::size_t middle = first + (last - first) / 2;
  std::nth_element(at(first), at(middle), at(last), [&](int a, int b) {
    const btScalar at_a = centers[static_cast<std::size_t>(a)][axis];
    const btScalar at_b = centers[static_cast<std::size_t>(b)][axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  divide(centers, order, first, middle, num_groups / 2, ends);
  divide(centers, order, middle, last, num_groups / 2, ends);
}

/// The starts of groups of at most so many elements; order gets the elements group by group, ascending within a group.
std::vector<std::size_t> divide(const std::vector<btVector3>& centers, std::size_t most,
                                std::vector<int>& order) {
  order.resize(centers.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<std::size_t> starts{0};
  divide(centers, order, 0, order.size(), std::bit_ceil((order.size() + most - 1) / most), starts);
  for (std::size_t p = 0; p + 1 < starts.size(); ++p) {
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(starts[p]),
              order.begin() + static_cast<std::ptrdiff_t>(starts[p + 1]));
  }
  return starts;
}

}  // namespace

bool meet(const MotionBox& a, const MotionBox& b) {
  int apart = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    apart |= static_cast<int>(a.low[k] > b.high[k]) | static_cast<int>(b.low[k] > a.high[k]);
  }
  return apart == 0;
}

MotionBox MotionBox::of(const btVector3& start, const btVector3& end) {
  MotionBox box{{0, 0, 0, 0}, {0, 0, 0, 0}};
  for (int k = 0; k < 3; ++k) {
    box.low[static_cast<std::size_t>(k)] = std::min(start[k], end[k]);
    box.high[static_cast<std::size_t>(k)] = std::max(start[k], end[k]);
  }
  return box;
}

MotionBox MotionBox::nowhere() {
  return {{kFar, kFar, kFar, kFar}, {-kFar, -kFar, -kFar, -kFar}};
}

void MotionBox::include(const MotionBox& other) {
  for (std::size_t k = 0; k < 4; ++k) low[k] = std::min(low[k], other.low[k]);
  for (std::size_t k = 0; k < 4; ++k) high[k] = std::max(high[k], other.high[k]);
}

MotionBox MotionBox::grown(btScalar distance) const {
  MotionBox box = *this;
  for (btScalar& low : box.low) low -= distance;
  for (btScalar& high : box.high) high += distance;
  return box;
}

void NodeGroups::arrange(const btSoftBody& body) {
  std::vector<btVector3> positions(static_cast<std::size_t>(body.m_nodes.size()));
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = body.m_nodes[static_cast<int>(i)].m_x;
  starts_ = divide(positions, kLargest, nodes_);
}

void NodeGroups::sort() {
  std::vector<std::vector<int>> groups(size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    groups[g].assign((*this)[g].begin(), (*this)[g].end());
    std::sort(groups[g].begin(), groups[g].end());
  }
  std::sort(groups.begin(), groups.end());
  nodes_.clear();
  starts_.assign(1, 0);
  for (const std::vector<int>& group : groups) {
    nodes_.insert(nodes_.end(), group.begin(), group.end());
    starts_.push_back(nodes_.size());
  }
}

void FaceTree::arrange(const btSoftBody& body) {
  const auto num_faces = static_cast<std::size_t>(body.m_faces.size());
  std::vector<btVector3> centers(num_faces);
  for (std::size_t f = 0; f < num_faces; ++f) {
    const btSoftBody::Face& face = body.m_faces[static_cast<int>(f)];
    centers[f] = face.m_n[0]->m_x + face.m_n[1]->m_x + face.m_n[2]->m_x;
  }
  std::vector<int> order;
  const std::vector<std::size_t> starts = divide(centers, kWidth, order);
  make_leaves(order, starts);
}

void FaceTree::make_leaves(const std::vector<int>& order, const std::vector<std::size_t>& starts) {
  leaves_.assign(starts.size() - 1, Leaf{});
  for (std::size_t l = 0; l < leaves_.size(); ++l) {
    Leaf& leaf = leaves_[l];
    leaf.size = starts[l + 1] - starts[l];
    std::copy_n(order.begin() + static_cast<std::ptrdiff_t>(starts[l]), leaf.size,
                leaf.faces.begin());
    for (std::size_t k = 0; k < 3; ++k) {
      leaf.low[k].fill(kFar);
      leaf.high[k].fill(-kFar);
    }
  }
  boxes_.assign(2 * leaves_.size(), MotionBox::nowhere());
  corners_.resize(order.size());
  weights_.resize(leaves_.size() * kWidth);
}

void FaceTree::refit(const btSoftBody& body, const btVector3& shift) {
  const auto num_faces = static_cast<std::size_t>(body.m_faces.size());
  if (num_faces == 0) {
    leaves_.clear();
    corners_.clear();
    return;
  }
  if (corners_.size() != num_faces) arrange(body);
  nodes_.resize(static_cast<std::size_t>(body.m_nodes.size()));
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    nodes_[i] = MotionBox::of(body.m_nodes[static_cast<int>(i)], shift);
  }
  // Anew each time: a tear leads faces to other nodes.
  for (std::size_t f = 0; f < num_faces; ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      corners_[f][k] =
          static_cast<int>(body.m_faces[static_cast<int>(f)].m_n[k] - &body.m_nodes[0]);
    }
  }
  const std::size_t num_leaves = leaves_.size();
  for (std::size_t l = 0; l < num_leaves; ++l) {
    fill(leaves_[l], boxes_[num_leaves + l]);
    for (std::size_t i = 0; i < leaves_[l].size; ++i) {
      weights_[l * kWidth + i] = weights_of(body.m_faces[leaves_[l].faces[i]]);
    }
  }
  for (std::size_t b = num_leaves - 1; b > 0; --b) {
    boxes_[b] = boxes_[2 * b];
    boxes_[b].include(boxes_[2 * b + 1]);
  }
}

void FaceTree::fill(Leaf& leaf, MotionBox& all) const {
  all = MotionBox::nowhere();
  for (std::size_t i = 0; i < leaf.size; ++i) {
    const std::array<int, 3>& corners = corners_[static_cast<std::size_t>(leaf.faces[i])];
    MotionBox box = nodes_[static_cast<std::size_t>(corners[0])];
    box.include(nodes_[static_cast<std::size_t>(corners[1])]);
    box.include(nodes_[static_cast<std::size_t>(corners[2])]);
    for (std::size_t k = 0; k < 3; ++k) {
      leaf.low[k][i] = box.low[k];
      leaf.high[k][i] = box.high[k];
    }
    all.include(box);
  }
}

FaceTree::Weights FaceTree::weights_of(const btSoftBody::Face& face) {
  const btVector3& a = face.m_n[0]->m_x;
  const btVector3 ab = face.m_n[1]->m_x - a;
  const btVector3 ac = face.m_n[2]->m_x - a;
  const btVector3 normal = btCross(ab, ac);
  const btScalar squared = normal.length2();
  const bool is_thin = !(squared > kThin * kThin * ab.length2() * ac.length2());
  const btScalar scale = is_thin ? btScalar(0) : 1 / squared;
  return {a, btCross(ac, normal) * scale, btCross(normal, ab) * scale};
}

void FaceTree::find(const MotionBox& box, Nearby& nearby,
                    const std::vector<char>& is_left_out) const {
  nearby.leaves.clear();
  for (auto* side : {&nearby.low, &nearby.high}) {
    for (std::vector<btScalar>& numbers : *side) numbers.clear();
  }
  std::array<std::size_t, 64> open{};  // two more than levels at most
  std::size_t num_open = leaves_.empty() ? 0 : 1;
  open[0] = 1;
  while (num_open > 0) {
    const std::size_t b = open[--num_open];
    if (!meet(boxes_[b], box)) continue;
    if (b < leaves_.size()) {
      open[num_open++] = 2 * b + 1;
      open[num_open++] = 2 * b;
      continue;
    }
    if (!is_left_out.empty() && is_left_out[b - leaves_.size()] != 0) continue;
    nearby.leaves.push_back(static_cast<int>(b - leaves_.size()));
    for (std::size_t k = 0; k < 3; ++k) nearby.low[k].push_back(boxes_[b].low[k]);
    for (std::size_t k = 0; k < 3; ++k) nearby.high[k].push_back(boxes_[b].high[k]);
  }
}

std::span<const int> FaceTree::collect(const MotionBox& box, Nearby& nearby) const {
  const std::size_t num_leaves = nearby.leaves.size();
  nearby.apart.assign(num_leaves, 0);
  int* const apart = nearby.apart.data();
  for (std::size_t k = 0; k < 3; ++k) {
    const btScalar* const low = nearby.low[k].data();
    const btScalar* const high = nearby.high[k].data();
    for (std::size_t l = 0; l < num_leaves; ++l) {
      apart[l] |= static_cast<int>(low[l] > box.high[k]) | static_cast<int>(box.low[k] > high[l]);
    }
  }
  if (nearby.slots.size() <= num_leaves * kWidth) nearby.slots.resize(num_leaves * kWidth + 1);
  int* next = nearby.slots.data();
  for (std::size_t l = 0; l < num_leaves; ++l) {
    if (apart[l] == 0) next = collect(nearby.leaves[l], box, next);
  }
  return {nearby.slots.data(), next};
}

// Every slot is written, and counted if its box meets: whether one does is as good as random to the
// processor, which would guess wrong at every other.
int* FaceTree::collect(int number, const MotionBox& box, int* next) const {
  const Leaf& leaf = leaves_[static_cast<std::size_t>(number)];
  std::array<int, kWidth> apart{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < kWidth; ++i) {
      apart[i] |= static_cast<int>(leaf.low[k][i] > box.high[k]) |
                  static_cast<int>(box.low[k] > leaf.high[k][i]);
    }
  }
  int slot = number * static_cast<int>(kWidth);
  for (std::size_t i = 0; i < kWidth; ++i) {
    *next = slot++;
    next += 1 - apart[i];
  }
  return next;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
