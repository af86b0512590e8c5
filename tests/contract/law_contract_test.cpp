// Every law of the registry against the claims of its row. A new row is tested without a new line
// here. What each check means stands in the headers of the checks; sabotage_test.cpp shows that
// each of them can fail.

#include <ostream>

#include "tests/contract/checks/derivative_checks.hpp"
#include "tests/contract/checks/energy_checks.hpp"
#include "tests/contract/checks/inertia_checks.hpp"
#include "tests/contract/checks/invariance_checks.hpp"
#include "tests/contract/checks/order_checks.hpp"
#include "tests/contract/checks/velocity_checks.hpp"

namespace weft::contract {

void PrintTo(const Subject& subject, std::ostream* out) {
  *out << subject.name;
}

namespace {

using forces::LawTraits;

class AnyLaw : public testing::TestWithParam<Subject> {};
class InternalLaw : public testing::TestWithParam<Subject> {};
class EnergyLaw : public testing::TestWithParam<Subject> {};
class EnergylessLaw : public testing::TestWithParam<Subject> {};
class DissipativeLaw : public testing::TestWithParam<Subject> {};
class LawBlindToRigidMotion : public testing::TestWithParam<Subject> {};
class LawFreeAtRest : public testing::TestWithParam<Subject> {};
class NodeByNodeLaw : public testing::TestWithParam<Subject> {};
class ElementLaw : public testing::TestWithParam<Subject> {};
class ForceLevelLaw : public testing::TestWithParam<Subject> {};
class InertiaLevelLaw : public testing::TestWithParam<Subject> {};
class LawWithoutInertia : public testing::TestWithParam<Subject> {};
class VelocityLevelLaw : public testing::TestWithParam<Subject> {};

std::string name_of(const testing::TestParamInfo<Subject>& info) {
  return info.param.name;
}

#define WEFT_FOR_LAWS(Suite, claim)                     \
  GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Suite); \
  INSTANTIATE_TEST_SUITE_P(Registry, Suite, testing::ValuesIn(subjects_that(claim)), name_of)

WEFT_FOR_LAWS(AnyLaw, [](const LawTraits&) { return true; });
WEFT_FOR_LAWS(InternalLaw, [](const LawTraits& t) { return t.internal; });
WEFT_FOR_LAWS(EnergyLaw, [](const LawTraits& t) { return t.has_energy; });
WEFT_FOR_LAWS(EnergylessLaw, [](const LawTraits& t) { return !t.has_energy; });
WEFT_FOR_LAWS(DissipativeLaw, [](const LawTraits& t) { return t.dissipative; });
WEFT_FOR_LAWS(ElementLaw, [](const LawTraits& t) {
  return t.elements != forces::ElementKind::kNodes && !t.needs_closed_surface;
});
WEFT_FOR_LAWS(NodeByNodeLaw, [](const LawTraits& t) { return t.is_pointwise; });
WEFT_FOR_LAWS(LawBlindToRigidMotion, [](const LawTraits& t) { return t.ignores_rigid_motion; });
WEFT_FOR_LAWS(LawFreeAtRest, [](const LawTraits& t) { return t.free_at_rest; });
WEFT_FOR_LAWS(ForceLevelLaw,
              [](const LawTraits& t) { return t.level == LawTraits::Level::kForce; });
WEFT_FOR_LAWS(VelocityLevelLaw,
              [](const LawTraits& t) { return t.level == LawTraits::Level::kVelocity; });

WEFT_FOR_LAWS(InertiaLevelLaw,
              [](const LawTraits& t) { return t.level == LawTraits::Level::kInertia; });
WEFT_FOR_LAWS(LawWithoutInertia,
              [](const LawTraits& t) { return t.level != LawTraits::Level::kInertia; });

#define WEFT_CHECK(Suite, Claim, check)    \
  TEST_P(Suite, Claim) {                   \
    EXPECT_TRUE(holds(check(GetParam()))); \
  }
#define WEFT_CHECK_SCALARS(Suite, Claim, check)                \
  TEST_P(Suite, Claim) {                                       \
    EXPECT_TRUE(holds(check<float>(GetParam()))) << "float";   \
    EXPECT_TRUE(holds(check<double>(GetParam()))) << "double"; \
  }

WEFT_CHECK(EnergyLaw, ForceIsMinusTheEnergyGradient, force_is_minus_energy_gradient)
WEFT_CHECK(EnergyLaw, StiffnessIsSymmetric, stiffness_is_symmetric)
WEFT_CHECK(EnergylessLaw, EnergyIsZero, energy_is_zero)
WEFT_CHECK(DissipativeLaw, PowerIsNeverPositive, power_is_never_positive)

WEFT_CHECK_SCALARS(InternalLaw, NetForceIsZero, net_force_is_zero)
WEFT_CHECK_SCALARS(InternalLaw, NetTorqueIsZero, net_torque_is_zero)
WEFT_CHECK_SCALARS(InternalLaw, ForceTurnsWithTheBody, force_turns_with_the_body)
WEFT_CHECK_SCALARS(LawBlindToRigidMotion, RigidMotionAddsNoForce, rigid_motion_adds_no_force)
WEFT_CHECK_SCALARS(LawFreeAtRest, RestShapeIsFreeOfForce, rest_shape_is_free_of_force)

WEFT_CHECK(VelocityLevelLaw, AdvanceSolvesTheEquation, advance_solves_the_equation)
WEFT_CHECK_SCALARS(VelocityLevelLaw, TwoHalfStepsAreOne, two_half_steps_are_one)
WEFT_CHECK_SCALARS(ForceLevelLaw, AdvanceChangesNothing, advance_changes_nothing)

WEFT_CHECK_SCALARS(InertiaLevelLaw, AddsNothing, inertia_adds_nothing)
WEFT_CHECK_SCALARS(InertiaLevelLaw, AdvanceChangesNothing, advance_changes_nothing)
WEFT_CHECK_SCALARS(InertiaLevelLaw, IsLinear, inertia_is_linear)
WEFT_CHECK_SCALARS(InertiaLevelLaw, KeepsTheNetForce, inertia_keeps_the_net_force)
WEFT_CHECK_SCALARS(InertiaLevelLaw, AddsNoTorque, inertia_adds_no_torque)
WEFT_CHECK_SCALARS(InertiaLevelLaw, KeepsUniformAccelerations, inertia_keeps_uniform_accelerations)
WEFT_CHECK_SCALARS(InertiaLevelLaw, IsSymmetric, inertia_is_symmetric)
WEFT_CHECK_SCALARS(InertiaLevelLaw, IsPositive, inertia_is_positive)
WEFT_CHECK_SCALARS(InertiaLevelLaw, RepeatsBitForBit, inertia_repeats_bit_for_bit)
WEFT_CHECK(InertiaLevelLaw, BalancesItsEnergy, inertia_balances_its_energy)
WEFT_CHECK(InertiaLevelLaw, FloatAgreesWithDoubleInRedistribution,
           inertia_in_float_agrees_with_double)
WEFT_CHECK_SCALARS(LawWithoutInertia, RedistributionChangesNothing, redistribution_changes_nothing)

WEFT_CHECK(AnyLaw, PowerIsAccountedFor, power_is_accounted_for)
WEFT_CHECK(AnyLaw, StiffnessIsTheDerivative, stiffness_is_the_derivative)
WEFT_CHECK(AnyLaw, StiffnessIsTheDifference, stiffness_is_the_difference)
WEFT_CHECK(AnyLaw, DampingIsTheDerivative, damping_is_the_derivative)
WEFT_CHECK(AnyLaw, DampingIsTheDifference, damping_is_the_difference)
WEFT_CHECK(AnyLaw, FloatAgreesWithDouble, float_agrees_with_double)
WEFT_CHECK_SCALARS(AnyLaw, EdgeOrderDoesNotMatter, edge_order_does_not_matter)
WEFT_CHECK_SCALARS(AnyLaw, NodeOrderDoesNotMatter, node_order_does_not_matter)
WEFT_CHECK_SCALARS(AnyLaw, CallsRepeatBitForBit, calls_repeat_bit_for_bit)
WEFT_CHECK_SCALARS(AnyLaw, ResultsAreAdded, results_are_added)
WEFT_CHECK_SCALARS(AnyLaw, TwoNodesSuffice, two_nodes_suffice)
WEFT_CHECK_SCALARS(NodeByNodeLaw, SomeNodesAreEnough, some_nodes_are_enough)
WEFT_CHECK_SCALARS(ElementLaw, NoElementsNoForce, no_elements_no_force)

}  // namespace
}  // namespace weft::contract
