#pragma once

// Tested by tests/bridge/cloth_body_test.cpp.

#include <weft/bridge/cloth_body.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Appends the links of settings.links to a body that has the nodes and masses of the mesh. Their
/// rest lengths are those of the mesh, wherever the nodes are now. Materials of a body are used
/// again where they fit, so that links made anew, time and again, need no more memory.
/// The caller has to call btSoftBody::updateLinkConstants().
void append_links(const ClothMesh& mesh, const ClothSettings& settings, btSoftBody& body);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
