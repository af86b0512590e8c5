#pragma once

#include <string>

namespace weft::tests {

/// A .gltf text with its bytes inside: a strip of four vertices on two joints.
///
///   nodes   0 "Root" at (0, 1, 0), its child 1 "Tip" at (0, 1, 0) above it, 2 "Strip", which has the
///           mesh "Ribbon" of the material "Silk", 3 "Flag", a rigid mesh on Tip of the same shape
///   strip   vertices (0,0,0) (1,0,0) (0,2,0) (1,2,0); the lower two follow Root, the upper two Root
///           and Tip to one half each
///   clip    "Move", 2 s: Root's translation linear (0,1,0) (2,1,0) (0,1,0) at 0, 1, 2 s; Tip's
///           rotation about z by steps 0, 90, 0 deg; Tip's scale cubic
///
/// Each colour's red channel is 0 for the lower, 1 for the upper vertices.
/// bind_width: what Tip's inverse bind matrix multiplies x with.
[[nodiscard]] std::string small_model(float bind_width = 1.0F);

/// The text with one place changed, which must be there.
[[nodiscard]] std::string changed(std::string text, const std::string& from, const std::string& to);

}  // namespace weft::tests
