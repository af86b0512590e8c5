#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/precision.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The faces of a soft body in a grid of cells, to be asked which of them may be near a point.
class FaceGrid {
 public:
  /// Every face with its box grown by reach [m], >= 0, at the nodes' m_x.
  void build(const btSoftBody& body, btScalar reach);
  /// Appends the faces, ascending, whose grown boxes may hold the point; none that holds it is
  /// missing.
  void collect(const btVector3& point, std::vector<int>& faces) const;

 private:
  using Key = std::uint64_t;
  [[nodiscard]] Key key_of(int x, int y, int z) const;
  [[nodiscard]] int cell_of(btScalar coordinate) const;

  void sort_into_lists();
  [[nodiscard]] std::size_t list_of(Key key) const;

  using Entry = std::pair<Key, int>;  // cell and face
  btScalar cell_size_ = 1;
  int shift_ = 64;                   ///< of a key's hash, to the number of its list
  std::vector<Entry> entries_;       ///< in the order of faces
  std::vector<Entry> sorted_;        ///< by list, then by face
  std::vector<std::size_t> starts_;  ///< of each list in sorted_, and the end of the last one
  std::vector<std::size_t> next_;    ///< place for the next entry of each list
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
