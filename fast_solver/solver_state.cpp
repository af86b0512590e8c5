// What a snapshot has of a solver.
// Tested by tests/engines/snapshot_test.cpp, tests/bridge/snapshot_test.cpp.
#include <algorithm>

#include <weft/fast_solver/implicit_solver.hpp>

namespace weft::fast {

// Everything else is computed anew in each step, from the network and the problem.
template <class Scalar>
void ImplicitSolver<Scalar>::serialize(StateArchive& archive) {
  archive.part("implicit solver");
  archive.expect(num_nodes(), "number of nodes");
  archive.runs(std::span(contact_states_).first(static_cast<std::size_t>(num_nodes())));
  anderson_.restart();
  if (!archive.is_reading()) return;
  const bool are_known =
      std::all_of(contact_states_.begin(), contact_states_.end(), [](ContactState state) {
        return state == ContactState::kFree || state == ContactState::kOnPlane ||
               state == ContactState::kFixed;
      });
  if (!are_known) archive.refuse("a contact state is unknown, expected free, sliding or sticking");
  std::fill(contact_of_.begin(), contact_of_.end(), -1);
  list_constrained();
}

template void ImplicitSolver<float>::serialize(StateArchive&);
template void ImplicitSolver<double>::serialize(StateArchive&);

}  // namespace weft::fast
