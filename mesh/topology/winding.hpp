#pragma once

#include <weft/core/types.hpp>

namespace weft {

/// The same triangles, each wound so that it runs along an edge the other way round than its neighbor does, as laws of bending and
/// of wind expect. Every connected piece keeps the winding of its first triangle. Where more than two triangles share an edge, and on
/// a surface that cannot be oriented (a Moebius strip), the first neighbor decides. triangles: 3 x t.
[[nodiscard]] Triangles wound_alike(const Triangles& triangles);

}  // namespace weft
