#pragma once

// Tested by tests/bridge/contact/layer_impacts_test.cpp.

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/cloth_contact.hpp>
#include <weft/bridge/contact/face_tree.hpp>
#include <weft/core/types.hpp>
#include <weft/mesh/distance/continuous_distance.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Keeps layers of cloth from passing through each other in a step: a node through a face, or an edge through an edge.
///
/// Nodes go straight from m_q to m_x. Where two such parts would come nearer than a share of the distance that they begin with
/// (continuous collision detection by conservative advancement), impulses take away their approach without a rebound (Bridson,
/// Fedkiw and Anderson 2002). Nodes that these do not settle move together: impact zones (Provot 1997), here without rotation.
///
/// A step that begins without intersections ends without any, unless its outcome is not clear, and but for places whose nodes are
/// all pinned. What intersects already is neither kept nor resolved: its parts pass each other no more, in either direction.
/// Impulses take kinetic energy away; pins may do work.
class LayerImpacts {
 public:
  /// A body and its contact, which knows its faces and the distances that it keeps; both must live until clear().
  struct Layer {
    btSoftBody* body;
    ClothContact* contact;
  };
  /// The outcome of resolve() for layers that meet each other, directly or by way of others.
  struct Outcome {
    int num_impacts = 0;  ///< all that were found
    int num_rounds = 0;   ///< of looking for more
    bool is_clear =
        true;  ///< nothing passes through anything; if not, it was too much, and nodes may be anywhere
  };

  void clear() { layers_.clear(), pairs_.clear(); }
  /// Layers have numbers from 0 on.
  void add(const Layer& layer) { layers_.push_back(layer); }
  /// Two layers that meet each other, or one that meets itself.
  void add_pair(std::size_t one, std::size_t other) { pairs_.emplace_back(one, other); }
  /// Changes m_x of nodes that an impulse can move, and says for each layer how that ended. Bits do not depend on the number of
  /// threads, nor on layers that a layer does not meet.
  std::vector<Outcome> resolve();

 private:
  /// The nodes and edges of a body's faces. Each of them belongs to one face, so that among faces that are near each
  /// other each pair of these is found once.
  struct Surface {
    std::vector<std::array<int, 3>> faces;
    std::vector<std::array<int, 2>> edges;
    std::vector<std::vector<int>> nodes_of_face, edges_of_face;
    std::vector<MotionBox> boxes;  ///< of its nodes, without their mean motion
    std::vector<char> is_changed;  ///< faces with such nodes
  };
  /// Some faces of a layer, and those of another one, or its own, that are near them.
  struct Search {
    std::size_t one, other;
    std::size_t first_leaf, last_leaf;  ///< of the one's tree of faces
  };
  /// Parts that would come too near: four nodes of all layers together, whose weighted sum is what parts them.
  struct Impact {
    PairKind kind;
    std::array<int, 4> nodes;
    std::array<double, 4> weights;
    Vector3<double> normal;
    double least;        ///< [m] separation along the normal at the end
    double impulse = 0;  ///< [kg m], a displacement times a mass
  };
  /// The memory of a search, and its result.
  struct Found {
    FaceTree::Nearby nearby;
    std::vector<MotionBox> boxes;  ///< of nodes of the one, in the other's motion
    std::vector<char> marks;       ///< of leaves: why they are not looked at
    std::vector<Impact> impacts;
    std::int64_t num_distances = 0;
    bool is_too_much = false;
  };
  class FacePair;

  /// Layers that meet each other, directly or by way of others.
  using Group = std::vector<std::size_t>;
  Outcome resolve(const Group& group);
  void find_surface(std::size_t layer);
  void read_nodes();
  [[nodiscard]] bool is_finite(const Group& group) const;
  void write_nodes(const Group& group);
  void find_boxes(std::size_t layer);
  void list_searches(const Group& group);
  /// False: there are too many parts near each other to look at all.
  [[nodiscard]] bool find_impacts(const Group& group);
  void search(const Search& what, Found& found) const;
  void try_pair(PairKind kind, const std::array<int, 4>& nodes, double thickness,
                Found& found) const;
  void apply_impulses();
  void move_zones_together();
  void move_together(const std::vector<int>& nodes);
  void move(int node, const Vector3<double>& end);
  [[nodiscard]] int zone_of(int node) const;

  std::vector<Layer> layers_;
  std::vector<ClothContact::Faces> faces_;  ///< of layers_, at their last look
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
  std::vector<Surface> surfaces_;   ///< of layers_, and of those before
  std::vector<int> first_nodes_;    ///< of each layer
  Matrix3X<double> starts_, ends_;  ///< of the nodes of all layers [m]
  VectorX<double> inverse_masses_;  ///< [1/kg]
  std::vector<char> is_moved_;      ///< nodes that are looked at again
  std::vector<Search> searches_;
  std::vector<Found> found_;  ///< by each search
  std::vector<Impact> impacts_;
  std::vector<int> zones_;  ///< a forest of nodes; empty: none yet
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
