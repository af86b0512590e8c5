#pragma once

// Tested by tests/mesh/cutting/tear_test.cpp.

#include <string>
#include <vector>

#include <weft/mesh/cutting/tear.hpp>

namespace weft {

/// Nodes at which a cloth is weaker, or stronger, than elsewhere: a seam.
struct WeakRegion {
  std::string node_set;  ///< of the mesh
  double strain = 0.0;   ///< limit [-] of edges with an end in it, > 0
};

/// When a cloth tears: at a node, across the most strained thread, which is cloth that gives way
/// between its threads.
struct TearRule {
  std::string edge_set = "stretch";  ///< its edges are the threads
  double strain = 0.5;               ///< (l - l0) / l0 [-] beyond which a thread tears, > 0
  /// Threads are not all alike: each has its limit times 1 - variation to 1 + variation [-], in
  /// [0, 1), by a hash of its rest position.
  double variation = 0.0;
  int max_splits = 4;                 ///< nodes that may give way per step, >= 1
  std::vector<WeakRegion> weak = {};  ///< the last one that holds an end of a thread counts
};

/// Throws InvalidArgument for values out of their domain and sets that the mesh does not have.
void check(const TearRule& rule, const ClothMesh& mesh);

/// The edges to cut now, 2 x m, for cut_along(); 2 x 0 if nothing tears or a position is not finite.
///
/// A thread beyond its limit makes one of its ends give way: the triangles around that node part by
/// the plane through it across the thread at rest, so that a crack runs across what pulls. Threads
/// are looked at by strain over limit, largest first, then by number; of the two ends that of a
/// weak region is preferred, then a free one to a pinned one, then one at the rim (where a crack
/// goes on), then the one whose threads are strained more, then the lower number. A
/// thread beside a node that gives way waits for the next step; where two cracks meet, the node between opens too.
/// A thread with a free end all of whose triangles are on its own side does not tear: behind such
/// an end the cloth is torn already, and nothing pulls.
/// Shapes   positions 3 x n [m]
/// Errors   InvalidArgument as check(), and for another number of positions
[[nodiscard]] Edges edges_to_tear(const ClothMesh& mesh, ConstMatrix3XRef<double> positions,
                                  const TearRule& rule);

/// cut_along() of edges_to_tear(), in less time than both.
[[nodiscard]] Tear tear_now(const ClothMesh& mesh, ConstMatrix3XRef<double> positions,
                            const TearRule& rule);

/// A blade: the parallelogram from (from - depth), (to - depth) to (from + depth), (to + depth).
struct Blade {
  Vector3<double> from{0, 0, 0};   ///< [m]
  Vector3<double> to{0, 0, 0};     ///< [m]
  Vector3<double> depth{0, 0, 0};  ///< [m] half the blade's width, through the cloth
};

/// The edges that a blade cuts, for cut_along(): those whose two triangles are on either side of it
/// and whose middle it meets. The cut follows the mesh, within a cell of the blade.
/// Throws InvalidArgument for a blade without area and for another number of positions than nodes.
[[nodiscard]] Edges edges_under(const Blade& blade, const ClothMesh& mesh,
                                ConstMatrix3XRef<double> positions);

}  // namespace weft
