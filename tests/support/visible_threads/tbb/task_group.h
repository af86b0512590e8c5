#pragma once

// Stands in for oneTBB's header, as parallel_for.h beside it: each task is a std::thread.

#include <thread>
#include <utility>
#include <vector>

namespace tbb {

class task_group {
 public:
  task_group() = default;
  task_group(const task_group&) = delete;
  task_group& operator=(const task_group&) = delete;
  ~task_group() { wait(); }

  template <class Task>
  void run(Task task) {
    threads_.emplace_back(std::move(task));
  }
  void wait() {
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }
  void cancel() {}

 private:
  std::vector<std::thread> threads_;
};

}  // namespace tbb
