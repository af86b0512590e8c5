#include <weft/fast_solver/solver_state.hpp>

#include <algorithm>

namespace weft::fast {

// Everything else is computed anew in each step, from the network and the problem.
template <class Scalar>
void SolverState::serialize(StateArchive& archive, ImplicitSolver<Scalar>& solver) {
  archive.part("implicit solver");
  archive.expect(solver.num_nodes(), "number of nodes");
  auto& states = solver.contact_states_;
  archive.runs(std::span(states).first(static_cast<std::size_t>(solver.num_nodes())));
  if (!archive.is_reading()) return;
  const bool are_known = std::all_of(states.begin(), states.end(), [](ContactState state) {
    return state == ContactState::kFree || state == ContactState::kOnPlane ||
           state == ContactState::kFixed;
  });
  if (!are_known) archive.refuse("a contact state is unknown, expected free, sliding or sticking");
  std::fill(solver.contact_of_.begin(), solver.contact_of_.end(), -1);
  solver.list_constrained();
}

template void SolverState::serialize(StateArchive&, ImplicitSolver<float>&);
template void SolverState::serialize(StateArchive&, ImplicitSolver<double>&);

}  // namespace weft::fast
