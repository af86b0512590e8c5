// Work without end is a blow-up that names its budget, and never a wait.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/reference/contact/search_budget.hpp>

#include "tests/reference/small_systems.hpp"

namespace weft::reference::testing {
namespace {

using ::testing::HasSubstr;

std::string reason_of(const StepOutcome& outcome) {
  return outcome.blow_up ? outcome.blow_up->body + ": " + outcome.blow_up->reason : "";
}

TEST(WorkBudget, EndsASearchInWhichEveryPartOfTheClothIsNearEveryOtherOne) {
  // 576 nodes that shall keep three times the size of the cloth from each other: two million pairs.
  Body cloth = make_cloth(24, 1.0, 0.1, 0.0, 10.0, 0.0);
  cloth.self_contact = true;
  cloth.self_thickness = 3.0;
  SpringSolver solver(system_of(std::move(cloth)));
  const StepOutcome outcome = solver.step(0.001);
  EXPECT_THAT(reason_of(outcome), HasSubstr("cloth: the contact search found "));
  EXPECT_THAT(reason_of(outcome), HasSubstr(" candidate pairs, more than the budget of "));
  EXPECT_TRUE(solver.system().bodies[0].positions.allFinite());
}

TEST(WorkBudget, LeavesACrumpledClothAlone) {
  // The same cloth, folded into zigzags at the distance that it keeps.
  Body cloth = make_cloth(24, 1.0, 0.1, 0.0, 10.0, 0.0);
  cloth.self_contact = true;
  cloth.self_thickness = 0.01;
  for (Eigen::Index i = 0; i < cloth.positions.cols(); ++i) {
    const double x = cloth.positions(0, i) + 0.5;
    const auto fold = static_cast<int>(x / 0.25);
    const double along = x - 0.25 * fold;
    cloth.positions(0, i) = fold % 2 == 0 ? along : 0.25 - along;
    cloth.positions(1, i) = 0.012 * fold;
  }
  SpringSolver solver(system_of(std::move(cloth)));
  for (int n = 0; n < 5; ++n) EXPECT_EQ(reason_of(solver.step(0.001)), "");
}

TEST(WorkBudget, GrowsWithTheCloth) {
  const SearchBudget small = search_budget(100), large = search_budget(10'000);
  EXPECT_EQ(large.pairs, 100 * small.pairs);
  EXPECT_EQ(large.distances, 100 * small.distances);
  EXPECT_EQ(search_budget(1'000'000'000).pairs, 50'000'000);
}

TEST(WorkBudget, EndsInnerStepsThatAreTooMany) {
  // w = sqrt(2 k / m) = 1.4e7 1/s: a step of 0.1 s has 200,000 periods.
  Body chain = make_chain(2, 1.0, 1e-6, 1e8);
  chain.positions(0, 1) += 1e-3;
  SpringSolver solver(system_of(std::move(chain)), {.integrator = IntegratorKind::kDormandPrince5});
  EXPECT_THAT(reason_of(solver.step(0.1)), HasSubstr("chain: the error of a step is over"));
}

TEST(WorkBudget, EndsAnImplicitStageThatDoesNotConverge) {
  // A storm of molten iron: forces of 1e15 N on a net of 10 kg.
  Body cloth = make_cloth(12, 1.0, 10.0, 0.0, 1.0, 0.0);
  add_law(cloth, "wind", {{"velocity", {0.004, 5308.0, 40.0}}, {"air_density", {3e7}}});
  SpringSolver solver(system_of(std::move(cloth)),
                      {.integrator = IntegratorKind::kImplicitMidpoint});
  std::string reason;
  for (int n = 0; n < 5 && reason.empty(); ++n) reason = reason_of(solver.step(0.0117));
  EXPECT_THAT(reason, HasSubstr("an implicit stage is not solved after 5000 iterations of GMRES"));
}

TEST(WorkBudget, EndsSearchesThatAreTooManyInOneStep) {
  // Every part is near every other one, in each of some thousand substeps: none of them is over its own budget.
  Body cloth = make_cloth(4, 1.0, 0.1, 0.0, 1e5, 0.0);
  cloth.self_contact = true;
  cloth.self_thickness = 3.0;
  SpringSolver solver(system_of(std::move(cloth)), {.guard = GuardPolicy::kSubstep});
  std::string reason;
  for (int n = 0; n < 5 && reason.empty(); ++n) reason = reason_of(solver.step(1.0));
  EXPECT_THAT(reason,
              HasSubstr("cloth: the contact search took more distances of pairs in the substeps"));
}

TEST(WorkBudget, EndsSweepsOverContactsThatCannotAllHold) {
  // A ceiling below the floor: no sweep of any of some thousand substeps converges.
  System system = system_of(make_chain(4, 1.0, 0.001, 1000.0));
  system.colliders.push_back({.name = "floor", .shape = Plane{}});
  Collider ceiling{.name = "ceiling", .shape = Plane{}, .position = {0, -0.002, 0}};
  ceiling.orientation = Eigen::AngleAxisd(M_PI, Vector3<double>::UnitX());
  system.colliders.push_back(std::move(ceiling));
  SpringSolver solver(std::move(system), {.guard = GuardPolicy::kSubstep});
  std::string reason;
  for (int n = 0; n < 5 && reason.empty(); ++n) reason = reason_of(solver.step(1.0));
  EXPECT_THAT(reason, HasSubstr("chain: the contact search visited contacts "));
  EXPECT_THAT(reason, HasSubstr(" times, more than the budget of 2000000"));
}

TEST(WorkBudget, RefusesSubstepsThatAreTooMany) {
  SpringSolver solver(system_of(make_chain(2, 1.0, 1e-6, 1e8)), {.guard = GuardPolicy::kSubstep});
  try {
    (void)solver.step(0.1);
    FAIL() << "no error";
  } catch (const InvalidArgument& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("time_step = 0.1 [s], expected at most "), std::string::npos) << message;
    EXPECT_NE(message.find(" substeps of "), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace weft::reference::testing
