#pragma once

// Tested by tests/core/parallel/parallel_for_test.cpp, tests/fast_solver/threads/worker_team_test.cpp.

namespace weft {

/// Tells the processor that this thread only waits.
inline void pause_processor() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

}  // namespace weft
