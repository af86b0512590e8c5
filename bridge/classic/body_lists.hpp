#pragma once

// Tested by tests/bridge/solver_checks_test.cpp, tests/bridge/implicit/fast_body_threads_test.cpp.

#include <vector>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/parallel/parallel_for.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

template <class Entry>
void drop_stopped(std::vector<Entry*>& list) {
  std::erase_if(list, [](const Entry* one) { return one->blow_up.has_value(); });
}

/// work(one) for each that it does not stop; those that it stops leave the list. A single one by the calling thread: its
/// team may be open, which must not wait for tasks.
template <class Entry, class Work>
void in_parallel(std::vector<Entry*>& list, const Work& work) {
  const auto work_on = [&](Entry& one) { one.guard([&] { work(one); }); };
  if (list.size() == 1) {
    work_on(*list[0]);
  } else {
    parallel_for(list.size(), [&](std::size_t i) { work_on(*list[i]); });
  }
  drop_stopped(list);
}

/// The same for those that must not work at the same time.
template <class Entry, class Work>
void in_turn(std::vector<Entry*>& list, const Work& work) {
  for (Entry* one : list) one->guard([&] { work(*one); });
  drop_stopped(list);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
