#pragma once

// Tested by tests/core/parallel/parallel_for_test.cpp, tests/core/parallel/task_group_test.cpp, tests/core/parallel/threads_test.cpp.

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include <weft/core/parallel/index_work.hpp>

namespace weft::pool {

/// Callers that share a number of threads: that of the calling program's threads, one of with_threads(), or that of a TaskGroup.
struct Arena {
  int num_threads = 1;  ///< with the caller
  int num_helpers = 0;  ///< threads of the pool that are at work in it; guarded by the pool
};

/// Calls of work(i) for i < count, which the pool's threads take one by one while it is open. It stays at its place until
/// ThreadPool::finish() returns.
struct Job {
  Job(std::size_t how_many, IndexWork what, Arena& where, Job* begun_in)
      : count(how_many), work(what), arena(where), parent(begun_in) {}

  [[nodiscard]] bool has_more() const { return next.load(std::memory_order_relaxed) < count; }
  [[nodiscard]] bool is_inside(const Job& other) const;
  /// Whether it, or what it was begun in, is to end early.
  [[nodiscard]] bool is_cancelled() const;

  const std::size_t count;
  const IndexWork work;
  Arena& arena;
  Job* const parent;  ///< the job that the thread was at work on that has begun this one, or null
  std::atomic<std::size_t> next{0};
  std::atomic<bool> is_stopped{false};
  /// Threads beside the one that waits for it; changed by the pool under its lock.
  std::atomic<int> num_helpers{0};
  std::exception_ptr thrown;  ///< the first; guarded by the pool
};

/// The threads of a process that work on jobs. A thread that waits for a job takes part in it and in jobs begun inside of it, and in no
/// other, so that waits cannot form a circle. Threads are started when they are first needed and joined when the program ends.
class ThreadPool {
 public:
  [[nodiscard]] static ThreadPool& instance();
  /// The arena and the job that the calling thread is at work in.
  [[nodiscard]] static Arena& current_arena();
  [[nodiscard]] static Job* current_job();
  /// work(0) in that arena.
  static void run_in(Arena& arena, IndexWork work);

  /// before_fork: the pool of the process that fork() has copied, whose threads are not there; or null.
  explicit ThreadPool(const ThreadPool* before_fork);
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  ThreadPool(ThreadPool&&) = delete;
  ThreadPool& operator=(ThreadPool&&) = delete;
  ~ThreadPool() = delete;  // objects that are destroyed after main() may still have loops

  /// Lets the pool's threads begin with the job.
  void open(Job& job);
  /// Does what nobody has begun, and waits for the rest. Throws what the job has thrown.
  void finish(Job& job);
  /// Ends all threads; jobs are then done by those who wait for them.
  void end();

 private:
  using Lock = std::unique_lock<std::mutex>;

  void run_worker();
  void work_on(Job& job);
  void help(Job& job, Lock& lock);
  void wait_for_job(Lock& lock);
  void wait_for_change(const Job& job, Lock& lock);
  void start_workers(int num_wanted, int most);
  [[nodiscard]] Job* find_job() const;
  [[nodiscard]] Job* find_job_inside(const Job& job) const;

  [[maybe_unused]] const ThreadPool* const
      before_fork_;   // so that what it holds does not count as lost
  Arena arena_;       ///< of threads that are in no other one
  std::mutex mutex_;  ///< guards all but the atomics
  std::condition_variable wake_;
  std::condition_variable changed_;  ///< for those who wait in finish()
  std::vector<std::thread> workers_;
  std::vector<Job*> open_;               ///< in the order in which they were opened
  std::atomic<unsigned> num_opened_{0};  ///< changes when a job is opened
  int num_spinning_ = 0;
  int num_asleep_ = 0;
  int num_waiting_ = 0;
  bool is_at_end_ = false;
};

}  // namespace weft::pool
