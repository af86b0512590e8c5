#pragma once

#include <vector>

#include "bench/bullet/work_precision.hpp"

namespace weft::bench {

/// NvCloth at several iteration counts, a step each, with long-range attachments ("tethers") and without. Its cloth has no
/// stiffness in N/m, its contact is one-way and it has no pressure: empty for workloads that need one.
[[nodiscard]] std::vector<Candidate> nvcloth_candidates(const Workload& workload);
/// Jolt at several iteration counts: springs of the workload's stiffness, and where nodes are held also with long-range
/// attachments.
[[nodiscard]] std::vector<Candidate> jolt_candidates(const Workload& workload);

}  // namespace weft::bench
