// The battery tested: for every check a law with one fault of 0.1 % that must fail it, and the same
// law without the fault that must pass. A check that cannot fail proves nothing.

#include "tests/contract/sabotage.hpp"

#include <ostream>

#include "tests/contract/checks/derivative_checks.hpp"
#include "tests/contract/checks/energy_checks.hpp"
#include "tests/contract/checks/inertia_checks.hpp"
#include "tests/contract/checks/invariance_checks.hpp"
#include "tests/contract/checks/order_checks.hpp"
#include "tests/contract/checks/velocity_checks.hpp"

namespace weft::contract {
namespace {

struct Control {
  std::string name;  ///< the fault, and the check that must find it
  std::string law;
  Fault fault;
  Measurement (*check)(const Subject&);
};

void PrintTo(const Control& control, std::ostream* out) {
  *out << control.name;
}

const std::vector<Control> kControls = {
    {"ForceSignFailsGradient", "tension", Fault::kForceSign, force_is_minus_energy_gradient},
    {"ForceWithoutEnergyFailsGradient", "tension", Fault::kForceWithoutEnergy,
     force_is_minus_energy_gradient},
    {"EnergyScaleFailsGradient", "tension", Fault::kEnergyScale, force_is_minus_energy_gradient},
    {"EnergyScaleFailsLinearGradient", "gravity", Fault::kEnergyScale,
     force_is_minus_energy_gradient},
    {"EnergyClaimedFailsZeroEnergy", "spring_damping", Fault::kEnergyClaimed, energy_is_zero},
    {"EnergyScaleFailsPower", "tension", Fault::kEnergyScale, power_is_accounted_for},
    {"PowerSignFailsPower", "spring_damping", Fault::kPowerSign, power_is_accounted_for},
    {"DampingSignFailsDissipation", "spring_damping", Fault::kDampingSign, power_is_never_positive},
    {"DampingSignFailsDampingProduct", "spring_damping", Fault::kDampingSign,
     damping_is_the_derivative},
    {"NetForceFailsNetForceFloat", "tension", Fault::kNetForce, net_force_is_zero<float>},
    {"NetForceFailsNetForceDouble", "tension", Fault::kNetForce, net_force_is_zero<double>},
    {"NetTorqueFailsNetTorqueFloat", "tension", Fault::kNetTorque, net_torque_is_zero<float>},
    {"NetTorqueFailsNetTorqueDouble", "tension", Fault::kNetTorque, net_torque_is_zero<double>},
    {"FixedDirectionFailsTurningFloat", "tension", Fault::kFixedDirection,
     force_turns_with_the_body<float>},
    {"FixedDirectionFailsTurningDouble", "tension", Fault::kFixedDirection,
     force_turns_with_the_body<double>},
    {"DragFailsRigidMotionFloat", "spring_damping", Fault::kDrag,
     rigid_motion_adds_no_force<float>},
    {"DragFailsRigidMotionDouble", "spring_damping", Fault::kDrag,
     rigid_motion_adds_no_force<double>},
    {"PrestressFailsRestFloat", "tension", Fault::kPrestress, rest_shape_is_free_of_force<float>},
    {"PrestressFailsRestDouble", "tension", Fault::kPrestress, rest_shape_is_free_of_force<double>},
    {"StiffnessScaleFailsDerivative", "tension", Fault::kStiffnessScale,
     stiffness_is_the_derivative},
    {"StiffnessScaleFailsDifference", "tension", Fault::kStiffnessScale,
     stiffness_is_the_difference},
    {"StiffnessUnsymmetricFailsSymmetry", "tension", Fault::kStiffnessUnsymmetric,
     stiffness_is_symmetric},
    {"DampingScaleFailsDerivative", "spring_damping", Fault::kDampingScale,
     damping_is_the_derivative},
    {"DampingScaleFailsDifference", "spring_damping", Fault::kDampingScale,
     damping_is_the_difference},
    {"FloatConstantFailsAgreement", "tension", Fault::kFloatConstant, float_agrees_with_double},
    {"FirstEdgeFailsEdgeOrderFloat", "tension", Fault::kFirstEdgeFavoured,
     edge_order_does_not_matter<float>},
    {"FirstEdgeFailsEdgeOrderDouble", "tension", Fault::kFirstEdgeFavoured,
     edge_order_does_not_matter<double>},
    {"FirstNodeFailsNodeOrderFloat", "tension", Fault::kFirstNodeFavoured,
     node_order_does_not_matter<float>},
    {"FirstNodeFailsNodeOrderDouble", "tension", Fault::kFirstNodeFavoured,
     node_order_does_not_matter<double>},
    {"FirstNodeFailsSomeNodesFloat", "gravity", Fault::kFirstNodeFavoured,
     some_nodes_are_enough<float>},
    {"FirstNodeFailsSomeNodesDouble", "gravity", Fault::kFirstNodeFavoured,
     some_nodes_are_enough<double>},
    {"HiddenStateFailsRepetition", "tension", Fault::kHiddenState,
     calls_repeat_bit_for_bit<double>},
    {"ThreadDependentFailsThreads", "tension", Fault::kThreadDependent,
     threads_change_no_bit<double>},
    {"OverwritingFailsAddition", "tension", Fault::kOverwrites, results_are_added<double>},
    {"ForceWithoutEdgesFailsNoEdges", "tension", Fault::kForceWithoutEdges,
     no_elements_no_force<double>},
    {"NotFiniteFailsTwoNodes", "tension", Fault::kNotFinite, two_nodes_suffice<double>},
    {"EulerDecayFailsEquation", "velocity_damping", Fault::kEulerDecay,
     advance_solves_the_equation},
    {"EulerDecayFailsHalfSteps", "velocity_damping", Fault::kEulerDecay,
     two_half_steps_are_one<double>},
    {"ChangedVelocitiesFailForceLevel", "tension", Fault::kChangesVelocities,
     advance_changes_nothing<double>},
    {"EulerDecayFailsRotationDamping", "rotation_damping", Fault::kEulerDecay,
     advance_solves_the_equation},
    {"EulerDecayFailsTorsionalDamping", "torsional_rotation_damping", Fault::kEulerDecay,
     advance_solves_the_equation},
};

const std::vector<Control> kInertiaControls = {
    {"NetForceFailsAddingNothingFloat", "acceleration_damping", Fault::kNetForce,
     inertia_adds_nothing<float>},
    {"NetForceFailsAddingNothingDouble", "acceleration_damping", Fault::kNetForce,
     inertia_adds_nothing<double>},
    {"SquareFailsLinearityFloat", "acceleration_damping", Fault::kInertiaSquare,
     inertia_is_linear<float>},
    {"SquareFailsLinearityDouble", "acceleration_damping", Fault::kInertiaSquare,
     inertia_is_linear<double>},
    {"InertiaOfAllFailsNetForceFloat", "acceleration_damping", Fault::kInertiaOfAll,
     inertia_keeps_the_net_force<float>},
    {"InertiaOfAllFailsNetForceDouble", "acceleration_damping", Fault::kInertiaOfAll,
     inertia_keeps_the_net_force<double>},
    {"InertiaOverPinsFailsPinnedForceFloat", "acceleration_damping", Fault::kInertiaOverPins,
     inertia_keeps_the_net_force<float>},
    {"InertiaOverPinsFailsPinnedForceDouble", "acceleration_damping", Fault::kInertiaOverPins,
     inertia_keeps_the_net_force<double>},
    {"TurnedForcesFailTorqueFloat", "acceleration_damping", Fault::kInertiaTurned,
     inertia_adds_no_torque<float>},
    {"TurnedForcesFailTorqueDouble", "acceleration_damping", Fault::kInertiaTurned,
     inertia_adds_no_torque<double>},
    {"InertiaOfAllFailsUniformAccelerationFloat", "acceleration_damping", Fault::kInertiaOfAll,
     inertia_keeps_uniform_accelerations<float>},
    {"InertiaOfAllFailsUniformAccelerationDouble", "acceleration_damping", Fault::kInertiaOfAll,
     inertia_keeps_uniform_accelerations<double>},
    {"TurnedForcesFailSymmetryFloat", "acceleration_damping", Fault::kInertiaTurned,
     inertia_is_symmetric<float>},
    {"TurnedForcesFailSymmetryDouble", "acceleration_damping", Fault::kInertiaTurned,
     inertia_is_symmetric<double>},
    {"ReversedForcesFailPositivityFloat", "acceleration_damping", Fault::kInertiaReversed,
     inertia_is_positive<float>},
    {"ReversedForcesFailPositivityDouble", "acceleration_damping", Fault::kInertiaReversed,
     inertia_is_positive<double>},
    {"HiddenStateFailsInertiaRepetitionFloat", "acceleration_damping", Fault::kInertiaHiddenState,
     inertia_repeats_bit_for_bit<float>},
    {"HiddenStateFailsInertiaRepetitionDouble", "acceleration_damping", Fault::kInertiaHiddenState,
     inertia_repeats_bit_for_bit<double>},
    {"InertiaEnergyFailsBalance", "acceleration_damping", Fault::kInertiaEnergy,
     inertia_balances_its_energy},
    {"InertiaFloatFailsAgreement", "acceleration_damping", Fault::kInertiaFloat,
     inertia_in_float_agrees_with_double},
    {"RedistributingFailsForceLevel", "tension", Fault::kInertiaOfAll,
     redistribution_changes_nothing<double>},
};

class Sabotage : public testing::TestWithParam<Control> {};

INSTANTIATE_TEST_SUITE_P(Battery, Sabotage, testing::ValuesIn(kControls),
                         [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Inertia, Sabotage, testing::ValuesIn(kInertiaControls),
                         [](const auto& info) { return info.param.name; });

TEST_P(Sabotage, IsFoundAndTheRightLawPasses) {
  const Control& control = GetParam();
  EXPECT_TRUE(holds(control.check(sabotaged(control.law, Fault::kNone))));
  EXPECT_FALSE(holds(control.check(sabotaged(control.law, control.fault))));
}

TEST(Measurement, NotANumberDoesNotHold) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(holds({nan, 1.0, "NaN"}));
  EXPECT_FALSE(holds({0.0, nan, "no bound"}));
}

TEST(Measurement, AFirstOrderErrorFailsASecondOrderClaim) {
  const std::vector<double> steps = {0.1, 0.05, 0.025};
  const std::vector<double> floors(3, 1e-15);
  EXPECT_TRUE(order_of_convergence("h^2", 2.0, steps, {1e-2, 2.5e-3, 6.25e-4}, floors).holds());
  EXPECT_FALSE(order_of_convergence("h", 2.0, steps, {1e-2, 5e-3, 2.5e-3}, floors).holds());
}

TEST(Measurement, ErrorsWithinTheirRoundOffTakeNoPartInTheFit) {
  const std::vector<double> steps = {0.1, 0.05, 0.025, 0.0125};
  const std::vector<double> floors = {1e-4, 2e-4, 4e-4, 8e-4};
  EXPECT_TRUE(order_of_convergence("h^2", 2.0, steps, {1e-2, 2.5e-3, 3e-4, 3e-4}, floors).holds());
  EXPECT_FALSE(order_of_convergence("h", 2.0, steps, {1e-2, 5e-3, 3e-4, 3e-4}, floors).holds());
  EXPECT_FALSE(order_of_convergence("one", 2.0, steps, {1e-2, 1e-4, 3e-4, 3e-4}, floors).holds());
}

}  // namespace
}  // namespace weft::contract
