#pragma once

// Stands in for oneTBB's header, as parallel_for.h beside it: an arena runs what it is given in the
// calling thread.

namespace tbb {

class task_arena {
 public:
  task_arena() = default;
  explicit task_arena(int max_concurrency) { initialize(max_concurrency); }
  void initialize(int max_concurrency) { max_concurrency_ = max_concurrency; }
  void terminate() { max_concurrency_ = 0; }
  [[nodiscard]] bool is_active() const { return max_concurrency_ > 0; }
  [[nodiscard]] int max_concurrency() const { return max_concurrency_; }
  template <class Function>
  auto execute(Function&& function) {
    return function();
  }

 private:
  int max_concurrency_ = 0;
};

namespace this_task_arena {
inline int max_concurrency() {
  return 4;
}
}  // namespace this_task_arena

}  // namespace tbb
