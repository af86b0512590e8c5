// Threads from oneTBB: the back end of WEFT_THREADS=TBB.
// Tested by tests/core/parallel/parallel_for_test.cpp, tests/core/parallel/task_group_test.cpp, tests/core/parallel/threads_test.cpp.
#include <algorithm>
#include <exception>
#include <optional>
#include <thread>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <tbb/version.h>

#include <weft/core/error.hpp>
#include <weft/core/parallel/parallel_for.hpp>
#include <weft/core/parallel/task_group.hpp>
#include <weft/core/parallel/threads.hpp>

namespace weft {

void run_parallel(std::size_t count, IndexWork work) {
  tbb::parallel_for(std::size_t{0}, count, [work](std::size_t index) { work(index); });
}

int num_threads() {
  return tbb::this_task_arena::max_concurrency();
}

std::string thread_library() {
  return "oneTBB " + std::to_string(TBB_VERSION_MAJOR) + "." + std::to_string(TBB_VERSION_MINOR);
}

void call_with_threads(int num_threads, IndexWork work) {
  if (num_threads < 1) {
    throw InvalidArgument("with_threads: num_threads = " + std::to_string(num_threads) +
                          ", expected >= 1");
  }
  // An arena alone has at most one thread per processor.
  const int num_processors = static_cast<int>(std::thread::hardware_concurrency());
  const tbb::global_control allowed(
      tbb::global_control::max_allowed_parallelism,
      static_cast<std::size_t>(std::max(num_threads, num_processors)));
  tbb::task_arena arena(num_threads);
  arena.execute([work] { work(0); });
}

void call_isolated(IndexWork work) {
  tbb::this_task_arena::isolate([work] { work(0); });
}

struct TaskGroup::Implementation {
  explicit Implementation(Place where) : place(where) {}

  void begin(std::size_t count, IndexWork work) {
    group.emplace();
    for (std::size_t i = 0; i < count; ++i) {
      group->run([work, i] { work(i); });
    }
  }

  Place place;
  tbb::task_arena arena;  ///< for Place::kApart
  /// Made by begin(): a group belongs to the loop that it was first used in, for ever.
  std::optional<tbb::task_group> group;
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
  if (own.place == Place::kHere) return own.begin(count, work);
  const int threads = num_threads();
  if (own.arena.is_active() && own.arena.max_concurrency() != threads) own.arena.terminate();
  if (!own.arena.is_active()) own.arena.initialize(threads);
  own.arena.execute([&] { own.begin(count, work); });
}

void TaskGroup::wait() {
  Implementation& own = *implementation_;
  if (!own.group) return;
  std::exception_ptr thrown;
  const auto finish = [&] {
    try {
      own.group->wait();
    } catch (...) {
      thrown = std::current_exception();
    }
    own.group.reset();
  };
  if (own.place == Place::kHere) {
    finish();
  } else {
    own.arena.execute(finish);
  }
  if (thrown) std::rethrow_exception(thrown);
}

void TaskGroup::cancel() {
  if (implementation_->group) implementation_->group->cancel();
}

}  // namespace weft
