#pragma once

// Tested by tests/reference/work_budget_test.cpp.

#include <algorithm>
#include <cstdint>
#include <string>

#include <weft/reference/system.hpp>

namespace weft::reference {

/// What the search for contacts between layers of cloth may cost in one step. Cloth that explodes
/// has every part of it near every other one, and would keep the search busy for hours: a search
/// beyond its budget is a blow-up, and never a wait. The budgets grow with the cloth and are some
/// ten times what crumpled cloth needs. Numbers of operations, not seconds: the same for every run.
struct SearchBudget {
  std::int64_t pairs = 0;      ///< candidate pairs of one look at the whole cloth
  std::int64_t distances = 0;  ///< distances of pairs in the step
  std::int64_t visits = 0;     ///< of a contact by a sweep, in the step
};

/// num_elements: nodes, edges and triangles that take part.
[[nodiscard]] constexpr SearchBudget search_budget(std::size_t num_elements) {
  constexpr std::int64_t kMaxPairs = 50'000'000;  // 1 GB
  const auto elements = static_cast<std::int64_t>(num_elements);
  return {std::min(500 * elements, kMaxPairs), 20'000 * elements, 50'000 * elements};
}

/// The budgets of so many substeps are there for all substeps of a step: some two hundred of a crumpled cloth.
inline constexpr double kSearchesOfStep = 20;

/// Visits of contacts with colliders by sweeps in one step, over all of its substeps; steps with faces or with cloth on cloth
/// end their sweeps early. A node that is wedged between two colliders may keep
/// every sweep from converging. Ten times what a ball takes that a net catches.
[[nodiscard]] inline std::int64_t contact_visit_budget(const System& system) {
  std::int64_t num_nodes = 0;
  for (const Body& body : system.bodies) num_nodes += body.positions.cols();
  constexpr std::int64_t kMostVisits = 5'000'000'000;
  return std::min(500'000 * num_nodes, kMostVisits);
}

/// "the contact search found 31 candidate pairs, more than the budget of 30"
[[nodiscard]] inline std::string over_budget(const char* what, std::int64_t count, const char* unit,
                                             std::int64_t budget) {
  return std::string("the contact search ") + what + ' ' + std::to_string(count) + ' ' + unit +
         ", more than the budget of " + std::to_string(budget);
}

}  // namespace weft::reference
