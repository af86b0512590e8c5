#pragma once

namespace weft::bench {

/// How long a line of the cache takes from one thread to another and to be seen there [us], a median: some .05 between
/// processors that share a cache, .27 between those that do not (EPYC, Zen 4). A host may move a virtual machine's.
/// Infinity if it takes some ten times that: the threads may have one processor.
[[nodiscard]] double line_transfer_time();

}  // namespace weft::bench
