#include <weft/bridge/face_grid.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

constexpr int kBits = 21;  // three of them in one key
constexpr int kHalfRange = 1 << (kBits - 1);
constexpr btScalar kSmallestCell = btScalar(1e-6);  // [m]: faces without any extent

struct Box {
  btVector3 low;
  btVector3 high;
};

Box box_of(const btSoftBody::Face& face, btScalar reach) {
  Box box{face.m_n[0]->m_x, face.m_n[0]->m_x};
  for (int k = 1; k < 3; ++k) {
    box.low.setMin(face.m_n[k]->m_x);
    box.high.setMax(face.m_n[k]->m_x);
  }
  const btVector3 grown(reach, reach, reach);
  box.low -= grown;
  box.high += grown;
  return box;
}

}  // namespace

// Cells beyond the range share those at its end: more candidates, none lost.
int FaceGrid::cell_of(btScalar coordinate) const {
  const btScalar cell = std::floor(coordinate / cell_size_);
  return static_cast<int>(std::clamp(cell, btScalar(-kHalfRange), btScalar(kHalfRange - 1)));
}

FaceGrid::Key FaceGrid::key_of(int x, int y, int z) const {
  const auto part = [](int cell) {
    const int from_zero = cell + kHalfRange;
    return static_cast<Key>(from_zero);
  };
  return part(x) << (2 * kBits) | part(y) << kBits | part(z);
}

void FaceGrid::build(const btSoftBody& body, btScalar reach) {
  btScalar sum = 0;
  for (int f = 0; f < body.m_faces.size(); ++f) {
    const Box box = box_of(body.m_faces[f], reach);
    const btVector3 extent = box.high - box.low;
    sum += extent[extent.maxAxis()];
  }
  const auto count = static_cast<btScalar>(std::max(1, body.m_faces.size()));
  cell_size_ = std::max(kSmallestCell, sum / count);
  entries_.clear();
  for (int f = 0; f < body.m_faces.size(); ++f) {
    const Box box = box_of(body.m_faces[f], reach);
    for (int x = cell_of(box.low.x()); x <= cell_of(box.high.x()); ++x) {
      for (int y = cell_of(box.low.y()); y <= cell_of(box.high.y()); ++y) {
        for (int z = cell_of(box.low.z()); z <= cell_of(box.high.z()); ++z) {
          entries_.emplace_back(key_of(x, y, z), f);
        }
      }
    }
  }
  sort_into_lists();
}

// By counting: entries were made in the order of faces and stay so within a list.
void FaceGrid::sort_into_lists() {
  const std::size_t num_lists = std::bit_ceil(std::max<std::size_t>(entries_.size(), 1));
  shift_ = 64 - std::countr_zero(num_lists);
  starts_.assign(num_lists + 1, 0);
  for (const Entry& entry : entries_) ++starts_[list_of(entry.first) + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  sorted_.resize(entries_.size());
  next_.assign(starts_.begin(), starts_.end());
  for (const Entry& entry : entries_) sorted_[next_[list_of(entry.first)]++] = entry;
}

// Multiplicative hashing: the upper bits of key times 2^64 / golden ratio.
std::size_t FaceGrid::list_of(Key key) const {
  return shift_ == 64 ? 0 : static_cast<std::size_t>((key * 0x9E3779B97F4A7C15U) >> shift_);
}

void FaceGrid::collect(const btVector3& point, std::vector<int>& faces) const {
  const Key key = key_of(cell_of(point.x()), cell_of(point.y()), cell_of(point.z()));
  const std::size_t list = list_of(key);
  for (std::size_t i = starts_[list]; i < starts_[list + 1]; ++i) {
    if (sorted_[i].first == key) faces.push_back(sorted_[i].second);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
