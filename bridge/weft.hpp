#pragma once

// Tested by tests/bridge/cloth_test.cpp.

/// The header of a Bullet program: solvers for its world, adoption of bodies that it has already, laws as types, handles.
/// An application includes it as <weft/weft.hpp>. Forces in Bullet's deformable world have headers of their own.

#include <weft/bridge/adoption/adopting_solver.hpp>
#include <weft/bridge/adoption/adoption.hpp>
#include <weft/bridge/cloth.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/drawn_body.hpp>
#include <weft/bridge/fast_settings.hpp>
#include <weft/bridge/snapshot.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/bridge/solver.hpp>
#include <weft/bridge/step_error.hpp>
#include <weft/bridge/tearing.hpp>
#include <weft/core/error.hpp>
#include <weft/core/parallel/threads.hpp>
#include <weft/custom_forces/typed_laws.hpp>
#include <weft/mesh/cloth_mesh.hpp>
