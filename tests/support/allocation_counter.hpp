#pragma once

namespace weft::test {

/// How often this program has asked for memory. The linker's --wrap replaces every reference to malloc,
/// operator new (_Znwm, and with alignment _ZnwmSt11align_val_t) and their relatives in the object files of
/// the program, and with them in Weft and in Eigen, whose temporaries come from malloc. Shared libraries
/// keep their own references, so what oneTBB takes from its pool for its tasks, and what Bullet takes, is not
/// counted. The counter is per process, so that worker threads count too.
/// A test that uses it calls weft_count_allocations(<target>) (tests/CMakeLists.txt).
[[nodiscard]] long num_allocations();

}  // namespace weft::test
