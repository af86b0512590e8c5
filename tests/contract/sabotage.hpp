#pragma once

#include <string>

#include "tests/contract/subject.hpp"

namespace weft::contract {

/// One mistake each, of the kind that a law can really have.
enum class Fault {
  kNone,
  kForceSign,
  kForceWithoutEnergy,  ///< a part of the force that has no energy
  kEnergyScale,         ///< energy 0.1 % too large
  kEnergyClaimed,       ///< a law without energy returns some
  kDampingSign,         ///< force and power with the wrong sign: feeds energy in
  kPowerSign,           ///< power alone with the wrong sign
  kNetForce,            ///< one node is pushed
  kNetTorque,           ///< equal and opposite forces that do not lie on one line
  kFixedDirection,      ///< equal and opposite forces along a fixed axis of the world
  kDrag,                ///< a force against the velocity over ground
  kPrestress,           ///< a force at the rest shape
  kStiffnessScale,      ///< product 0.1 % too large
  kStiffnessUnsymmetric,
  kDampingScale,       ///< product 0.1 % too large
  kFirstEdgeFavoured,  ///< depends on the order of edges
  kFirstNodeFavoured,  ///< depends on the order of nodes
  kHiddenState,        ///< remembers the previous call
  kThreadDependent,
  kOverwrites,  ///< sets the result instead of adding to it
  kForceWithoutEdges,
  kNotFinite,
  kFloatConstant,       ///< the float law has another parameter
  kEulerDecay,          ///< v (1 - gamma dt) instead of v exp(-gamma dt)
  kChangesVelocities,   ///< a law of level kForce touches velocities
  kInertiaOfAll,        ///< divides the acceleration of the centre of mass too
  kInertiaOverPins,     ///< acts on the force of the first node, which is pinned
  kInertiaSquare,       ///< a part that grows as the square of the force
  kInertiaTurned,       ///< turns forces a little about an axis
  kInertiaReversed,     ///< forces against their accelerations
  kInertiaHiddenState,  ///< remembers the previous call
  kInertiaEnergy,       ///< added kinetic energy 0.1 % too large
  kInertiaFloat,        ///< the float law has another parameter
};

/// The registered law with typical parameters and one fault. Its traits stay those of the law, so
/// its claims are false.
[[nodiscard]] Subject sabotaged(const std::string& law, Fault fault);

}  // namespace weft::contract
