#pragma once

// Tested by tests/contract/input_contract_test.cpp, tests/contract/law_contract_test.cpp.

#include <weft/custom_forces/laws/damping/acceleration_damping.hpp>
#include <weft/custom_forces/laws/damping/rotation_damping.hpp>
#include <weft/custom_forces/laws/damping/spring_damping.hpp>
#include <weft/custom_forces/laws/damping/torsional_rotation_damping.hpp>
#include <weft/custom_forces/laws/damping/velocity_damping.hpp>
#include <weft/custom_forces/laws/elastic/hinge_torsion.hpp>
#include <weft/custom_forces/laws/elastic/nonlocal_torsion.hpp>
#include <weft/custom_forces/laws/elastic/tension.hpp>
#include <weft/custom_forces/laws/elastic/torsion.hpp>
#include <weft/custom_forces/laws/external/drive.hpp>
#include <weft/custom_forces/laws/external/gravity.hpp>
#include <weft/custom_forces/laws/external/pressure.hpp>
#include <weft/custom_forces/laws/external/wind.hpp>

namespace weft::forces {

template <template <class> class... Laws>
struct LawList {};

// clang-format off
/// The one list of laws, in the order in which they are shown. Everything that enumerates laws is made from it.
using AllLaws = LawList<
    Tension,
    SpringDamping,
    Torsion,
    HingeTorsion,
    NonlocalTorsion,
    AccelerationDamping,
    RotationDamping,
    TorsionalRotationDamping,
    VelocityDamping,
    Wind,
    Pressure,
    Gravity,
    Drive>;
// clang-format on

}  // namespace weft::forces
