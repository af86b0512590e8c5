#pragma once

#include <memory>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Whether a btSoftBody still exists. An address does not tell: a body that is deleted and the next one
/// that is made often have the same.
///
/// Bullet tells nobody that a body is deleted, but every body owns a collision shape and deletes it with
/// itself. follow_life() puts a shape of ours in front of that one. It answers every question as the
/// body's own shape does, which it owns from then on, and notes its own end. The body keeps it for its
/// life; the record lives as long as anybody has it.
struct BodyLife {
  bool is_alive = true;
  /// That has laws or contacts for the body; none: Bullet alone steps it. A body in front of whose shape
  /// another solver is named refuses to be added to a world: InvalidArgument out of addSoftBody(), before
  /// the broadphase knows the body; removeSoftBody() takes it out again.
  const btSoftBodySolver* solver = nullptr;
};

/// The record of a body, the same for all that ask.
[[nodiscard]] std::shared_ptr<BodyLife> follow_life(btSoftBody& body);

/// Throws InvalidArgument, its text starting with who, for a body that a world steps with another solver,
/// or that has laws of another one: what is attached would do nothing, silently.
void check_solver(const char* who, const btSoftBody& body, const btSoftBodySolver& solver);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
