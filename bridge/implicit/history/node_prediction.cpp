#include <weft/bridge/implicit/history/node_prediction.hpp>

#include <array>
#include <atomic>
#include <numeric>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/fast_solver/threads/node_partition.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Steps that boxes look ahead when all of them are made anew.
constexpr btScalar kCoveredSteps = 8;
/// One in so many nodes may be put into the tree one by one.
constexpr int kFewShare = 50;
/// A tree's depth is some 20; one that nodes were put into in a row is made anew.
constexpr int kMostDepth = 200;
/// Depth down to which threads share the subtrees of a tree.
constexpr int kSharedDepth = 4;

btVector3 vector_of(const Four& v) {
  return {v[0], v[1], v[2]};
}

struct Box {
  Four low;
  Four high;
};

/// Moves the nodes begin ... end - 1 and returns the box that they start from and end in.
Box integrate(btSoftBody& body, btScalar time_step, int begin, int end) {
  const btVector3 gravity = body.m_worldInfo->m_gravity * time_step;
  const Four fall(gravity.x(), gravity.y(), gravity.z(), 0);
  const btScalar most = body.m_worldInfo->m_maxDisplacement / time_step;
  Four low = four(body.m_nodes[begin].m_x);
  Four high = low;
  for (int i = begin; i < end; ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    const Four start = four(node.m_x);
    const Four push = (four(node.m_f) * node.m_im * time_step).min(most).max(-most);
    Four velocity = four(node.m_v);
    if (node.m_im > 0) velocity += fall;
    velocity += push;
    const Four target = start + velocity * time_step;
    four(node.m_q) = start;
    four(node.m_v) = velocity;
    four(node.m_x) = target;
    four(node.m_f).setZero();
    low = low.min(start).min(target);
    high = high.max(start).max(target);
  }
  return {low, high};
}

void integrate(btSoftBody& body, btScalar time_step, fast::WorkerTeam& team) {
  const fast::NodePartition ranges(body.m_nodes.size());
  std::array<Box, fast::WorkerTeam::kMostParts> boxes;
  boxes.fill({Four::Zero(), Four::Zero()});
  fast::run_parts(team, body.m_nodes.size(), [&](int range, int begin, int end) {
    boxes[static_cast<std::size_t>(range)] = integrate(body, time_step, begin, end);
  });
  Box all = boxes[0];
  for (int range = 1; range < ranges.count(); ++range) {
    all.low = all.low.min(boxes[static_cast<std::size_t>(range)].low);
    all.high = all.high.max(boxes[static_cast<std::size_t>(range)].high);
  }
  body.m_bounds[0] = vector_of(all.low - body.m_sst.radmrg);
  body.m_bounds[1] = vector_of(all.high + body.m_sst.radmrg);
}

btDbvtVolume box_of(const btSoftBody::Node& node, btScalar margin) {
  return btDbvtVolume::FromCR(node.m_x, margin);
}

/// From leaves, or nodes of a depth, upwards. False if the tree is too deep.
bool refit(btDbvtNode* node, int depth, int end = kMostDepth + 1) {
  if (node->isleaf() || depth == end) return true;
  if (depth > kMostDepth) return false;
  for (btDbvtNode* child : node->childs) {
    if (!refit(child, depth + 1, end)) return false;
  }
  Merge(node->childs[0]->volume, node->childs[1]->volume, node->volume);
  return true;
}

struct Subtrees {
  std::array<btDbvtNode*, 1 << kSharedDepth> roots;
  int count = 0;

  void add_below(btDbvtNode* node, int depth) {
    if (depth == kSharedDepth) {
      roots[static_cast<std::size_t>(count++)] = node;
    } else if (node->isinternal()) {
      for (btDbvtNode* child : node->childs) add_below(child, depth + 1);
    }
  }
};

bool refit(btDbvt& tree, fast::WorkerTeam& team) {
  Subtrees subtrees;
  subtrees.add_below(tree.m_root, 0);
  std::atomic<bool> fits = true;
  team.run(subtrees.count, [&](int k) {
    if (!refit(subtrees.roots[static_cast<std::size_t>(k)], kSharedDepth)) fits = false;
  });
  return fits && refit(tree.m_root, 0, kSharedDepth);
}

void cover_ways(btSoftBody& body, ConstMatrix3XRef<btScalar> last_velocities,
                fast::WorkerTeam& team) {
  const bool has_last = last_velocities.cols() == body.m_nodes.size();
  const btScalar ahead = kCoveredSteps * body.m_sst.sdt + body.m_sst.velmrg;
  const auto cover = [&](int i) {
    btSoftBody::Node& node = body.m_nodes[i];
    btDbvtVolume box = box_of(node, body.m_sst.radmrg);
    box.SignedExpand(node.m_v * ahead);
    btVector3 bend(body.m_sst.updmrg, body.m_sst.updmrg, body.m_sst.updmrg);
    if (has_last) {
      const Vector3<btScalar> last = last_velocities.col(i);
      bend += ahead * kCoveredSteps / 2 * (node.m_v - to_bullet(last)).absolute();
    }
    box.Expand(bend);
    node.m_leaf->volume = box;
  };
  fast::run_parts(team, body.m_nodes.size(), [&](int, int begin, int end) {
    for (int i = begin; i < end; ++i) cover(i);
  });
  if (!refit(body.m_ndbvt, team)) body.m_ndbvt.optimizeTopDown();
}

void update_tree(btSoftBody& body, ConstMatrix3XRef<btScalar> last_velocities,
                 std::vector<int>& left, fast::WorkerTeam& team) {
  if (body.m_ndbvt.m_root == nullptr) return;
  const btScalar margin = body.m_sst.radmrg;
  const int few = body.m_nodes.size() / kFewShare;
  const fast::NodePartition ranges(body.m_nodes.size());
  std::array<int, fast::WorkerTeam::kMostParts> num_left{};
  left.resize(static_cast<std::size_t>(body.m_nodes.size()));
  fast::run_parts(team, body.m_nodes.size(), [&](int range, int begin, int end) {
    int count = 0;
    for (int i = begin; i < end && count <= few; ++i) {
      const btSoftBody::Node& node = body.m_nodes[i];
      if (node.m_leaf->volume.Contain(box_of(node, margin))) continue;
      left[static_cast<std::size_t>(begin + count++)] = i;
    }
    num_left[static_cast<std::size_t>(range)] = count;
  });
  if (std::accumulate(num_left.begin(), num_left.end(), 0) > few) {
    return cover_ways(body, last_velocities, team);
  }
  for (int range = 0; range < ranges.count(); ++range) {
    const auto first = static_cast<std::size_t>(ranges[range].begin);
    const auto count = static_cast<std::size_t>(num_left[static_cast<std::size_t>(range)]);
    for (std::size_t k = first; k < first + count; ++k) {
      btSoftBody::Node& node = body.m_nodes[left[k]];
      btDbvtVolume box = box_of(node, margin);
      body.m_ndbvt.update(node.m_leaf, box, node.m_v * body.m_sst.velmrg, body.m_sst.updmrg);
    }
  }
}

void update_face_tree(btSoftBody& body) {
  if (body.m_fdbvt.empty()) return;
  for (int f = 0; f < body.m_faces.size(); ++f) {
    btSoftBody::Face& face = body.m_faces[f];
    std::array<const btVector3*, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = &face.m_n[k]->m_x;
    btDbvtVolume box = btDbvtVolume::FromPoints(corners.data(), 3);
    const btScalar margin = body.m_sst.radmrg;
    box.Expand(btVector3(margin, margin, margin));
    const btVector3 velocity = (face.m_n[0]->m_v + face.m_n[1]->m_v + face.m_n[2]->m_v) / 3;
    body.m_fdbvt.update(face.m_leaf, box, velocity * body.m_sst.velmrg, body.m_sst.updmrg);
  }
}

}  // namespace

bool has_air(const btSoftBody::Config& settings) {
  return settings.kLF > 0 || settings.kDG > 0 || settings.kPR != 0 || settings.kVC > 0;
}

bool is_plain(const btSoftBody& body) {
  return !body.m_bUpdateRtCst && body.m_clusters.size() == 0 && !body.m_pose.m_bframe &&
         body.m_cfg.timescale == btScalar(1) && !has_air(body.m_cfg) && body.m_nodes.size() > 0;
}

void predict_nodes(btSoftBody& body, btScalar time_step, ConstMatrix3XRef<btScalar> last_velocities,
                   bool keeps_tree, std::vector<int>& scratch, fast::WorkerTeam& team) {
  body.m_sst.sdt = time_step;
  body.m_sst.isdt = 1 / time_step;
  body.m_sst.velmrg = 3 * time_step;
  body.m_sst.radmrg = body.getCollisionShape()->getMargin();
  body.m_sst.updmrg = body.m_sst.radmrg * btScalar(0.25);
  integrate(body, time_step, team);
  if (keeps_tree) {
    update_tree(body, last_velocities, scratch, team);
    body.m_ndbvt.optimizeIncremental(1);
  }
  update_face_tree(body);
  body.m_fdbvt.optimizeIncremental(1);
  body.m_rcontacts.resizeNoInitialize(0);
  body.m_scontacts.resizeNoInitialize(0);
}

void publish_bounds(btSoftBody& body) {
  if (btBroadphaseProxy* const proxy = body.getBroadphaseHandle()) {
    body.m_worldInfo->m_broadphase->setAabb(proxy, body.m_bounds[0], body.m_bounds[1],
                                            body.m_worldInfo->m_dispatcher);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
