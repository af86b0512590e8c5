// A program that does not look at what attach_fast() answers: the compiler has to tell it so. This file is meant not to compile.
#include <weft/bridge/solver.hpp>

void attach(weft::bridge::SoftBodySolver& solver, btSoftBody& body, const weft::ClothMesh& mesh) {
  solver.attach_fast(body, mesh, {{"tension", {}, {{"stiffness", {100.0}}}}});
}
