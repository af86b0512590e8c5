// Threads of Weft's own, without any library: the back end of WEFT_THREADS=STD.
// Tested by tests/core/parallel/parallel_for_test.cpp, tests/core/parallel/task_group_test.cpp, tests/core/parallel/threads_test.cpp.
#include <exception>
#include <optional>

#include <weft/core/error.hpp>
#include <weft/core/parallel/parallel_for.hpp>
#include <weft/core/parallel/task_group.hpp>
#include <weft/core/parallel/thread_pool.hpp>
#include <weft/core/parallel/threads.hpp>

namespace weft {

using pool::Arena;
using pool::Job;
using pool::ThreadPool;

void run_parallel(std::size_t count, IndexWork work) {
  Arena& arena = ThreadPool::current_arena();
  Job* const parent = ThreadPool::current_job();
  if (count <= 1 || arena.num_threads <= 1) {
    for (std::size_t i = 0; i < count && !(parent && parent->is_cancelled()); ++i) work(i);
    return;
  }
  Job job(count, work, arena, parent);
  ThreadPool::instance().open(job);
  ThreadPool::instance().finish(job);
}

int num_threads() {
  return ThreadPool::current_arena().num_threads;
}

std::string thread_library() {
  return "std::thread";
}

void call_with_threads(int num_threads, IndexWork work) {
  if (num_threads < 1) {
    throw InvalidArgument("with_threads: num_threads = " + std::to_string(num_threads) +
                          ", expected >= 1");
  }
  Arena arena{num_threads};
  ThreadPool::run_in(arena, work);
}

// A thread of the pool that waits takes nothing but what was begun inside of what it waits for.
void call_isolated(IndexWork work) {
  work(0);
}

struct TaskGroup::Implementation {
  explicit Implementation(Place where) : place(where) {}

  Place place;
  Arena apart;  ///< for Place::kApart
  std::optional<Job> job;
};

TaskGroup::TaskGroup(Place place) : implementation_(std::make_unique<Implementation>(place)) {}

TaskGroup::~TaskGroup() {
  cancel();
  try {
    wait();
  } catch (...) {
    // An exception of a task concerned a result that nobody has waited for.
  }
}

void TaskGroup::begin(std::size_t count, IndexWork work) {
  Implementation& own = *implementation_;
  if (own.place == Place::kHere) {
    own.job.emplace(count, work, ThreadPool::current_arena(), ThreadPool::current_job());
  } else {
    own.apart.num_threads = num_threads();
    own.job.emplace(count, work, own.apart, nullptr);
  }
  ThreadPool::instance().open(*own.job);
}

void TaskGroup::wait() {
  Implementation& own = *implementation_;
  if (!own.job) return;
  std::exception_ptr thrown;
  try {
    ThreadPool::instance().finish(*own.job);
  } catch (...) {
    thrown = std::current_exception();
  }
  own.job.reset();
  if (thrown) std::rethrow_exception(thrown);
}

void TaskGroup::cancel() {
  if (implementation_->job) implementation_->job->is_stopped.store(true, std::memory_order_relaxed);
}

}  // namespace weft
