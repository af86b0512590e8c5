#include <weft/core/parallel/thread_pool.hpp>

#include <algorithm>
#include <system_error>
#include <utility>

#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#endif

#include <weft/core/parallel/processor_pause.hpp>

namespace weft::pool {
namespace {

/// How often a thread looks before it sleeps: some 50 us. To wake it takes up to as long, and loops of a step follow each
/// other faster.
constexpr int kLooks = 2000;

/// The arena and the job that the calling thread works in.
struct Context {
  Arena* arena = nullptr;  ///< null for that of the pool
  Job* job = nullptr;
};
thread_local Context context;

class ContextScope {
 public:
  explicit ContextScope(Context inside) : outside_(std::exchange(context, inside)) {}
  ContextScope(const ContextScope&) = delete;
  ContextScope& operator=(const ContextScope&) = delete;
  ContextScope(ContextScope&&) = delete;
  ContextScope& operator=(ContextScope&&) = delete;
  ~ContextScope() { context = outside_; }

 private:
  Context outside_;
};

template <class Condition>
void spin_until(const Condition& condition) {
  for (int look = 0; look < kLooks && !condition(); ++look) pause_processor();
}

ThreadPool* the_pool = nullptr;  // set once, and anew in a process made by fork()

/// Joins the threads before the code that they run is unloaded.
struct EndOfProgram {
  EndOfProgram() = default;
  EndOfProgram(const EndOfProgram&) = delete;
  EndOfProgram& operator=(const EndOfProgram&) = delete;
  EndOfProgram(EndOfProgram&&) = delete;
  EndOfProgram& operator=(EndOfProgram&&) = delete;
  ~EndOfProgram() { the_pool->end(); }
};

ThreadPool* make_pool() {
#if defined(__unix__) || defined(__APPLE__)
  pthread_atfork(nullptr, nullptr, [] { the_pool = new ThreadPool(the_pool); });
#endif
  the_pool = new ThreadPool(nullptr);
  return the_pool;
}

}  // namespace

bool Job::is_inside(const Job& other) const {
  const Job* job = this;
  while (job && job != &other) job = job->parent;
  return job != nullptr;
}

bool Job::is_cancelled() const {
  const Job* job = this;
  while (job && !job->is_stopped.load(std::memory_order_relaxed)) job = job->parent;
  return job != nullptr;
}

ThreadPool::ThreadPool(const ThreadPool* before_fork) : before_fork_(before_fork) {
  arena_.num_threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

ThreadPool& ThreadPool::instance() {
  [[maybe_unused]] static const ThreadPool* const first = make_pool();
  static const EndOfProgram end;
  return *the_pool;
}

Arena& ThreadPool::current_arena() {
  return context.arena ? *context.arena : instance().arena_;
}

Job* ThreadPool::current_job() {
  return context.job;
}

void ThreadPool::run_in(Arena& arena, IndexWork work) {
  const ContextScope scope({&arena, context.job});
  work(0);
}

void ThreadPool::open(Job& job) {
  const Lock lock(mutex_);
  open_.push_back(&job);
  num_opened_.fetch_add(1, std::memory_order_release);
  if (num_waiting_ > 0) changed_.notify_all();
  const int room = job.arena.num_threads - 1 - job.arena.num_helpers;
  const int num_wanted =
      static_cast<int>(std::min(job.count, static_cast<std::size_t>(std::max(0, room))));
  int num_to_wake = std::min(num_wanted - num_spinning_, num_asleep_);
  for (; num_to_wake > 0; --num_to_wake) wake_.notify_one();
  start_workers(num_wanted - num_spinning_ - num_asleep_, job.arena.num_threads - 1);
}

// With fewer threads than wanted all is done as well.
void ThreadPool::start_workers(int num_wanted, int most) {
  if (is_at_end_) return;
  try {
    for (; num_wanted > 0 && static_cast<int>(workers_.size()) < most; --num_wanted) {
      workers_.emplace_back([this] { run_worker(); });
    }
  } catch (const std::system_error&) {
  }
}

void ThreadPool::end() {
  {
    const Lock lock(mutex_);
    is_at_end_ = true;
    wake_.notify_all();
  }
  for (std::thread& worker : workers_) worker.join();
  workers_.clear();
}

void ThreadPool::run_worker() {
  Lock lock(mutex_);
  while (!is_at_end_) {
    if (Job* const job = find_job()) {
      Arena& arena = job->arena;
      ++arena.num_helpers;
      help(*job, lock);
      --arena.num_helpers;
    } else {
      wait_for_job(lock);
    }
  }
}

void ThreadPool::wait_for_job(Lock& lock) {
  const unsigned seen = num_opened_.load(std::memory_order_relaxed);
  const auto is_there_more = [&] { return num_opened_.load(std::memory_order_relaxed) != seen; };
  ++num_spinning_;
  lock.unlock();
  spin_until(is_there_more);
  lock.lock();
  --num_spinning_;
  ++num_asleep_;
  wake_.wait(lock, [&] { return is_at_end_ || is_there_more(); });
  --num_asleep_;
}

/// The oldest first: what is begun inside of it is smaller.
Job* ThreadPool::find_job() const {
  const auto found = std::find_if(open_.begin(), open_.end(), [](const Job* job) {
    return job->arena.num_helpers < job->arena.num_threads - 1 && job->has_more();
  });
  return found == open_.end() ? nullptr : *found;
}

Job* ThreadPool::find_job_inside(const Job& job) const {
  const auto found = std::find_if(open_.begin(), open_.end(), [&](const Job* one) {
    return one->has_more() && one->is_inside(job);
  });
  return found == open_.end() ? nullptr : *found;
}

// Whoever waits for the job goes on once the lock is free: nothing looks at the job after that.
void ThreadPool::help(Job& job, Lock& lock) {
  job.num_helpers.fetch_add(1, std::memory_order_relaxed);
  lock.unlock();
  work_on(job);
  lock.lock();
  const int before = job.num_helpers.fetch_sub(1, std::memory_order_release);
  if (before == 1 && num_waiting_ > 0) changed_.notify_all();
}

void ThreadPool::work_on(Job& job) {
  const ContextScope scope({&job.arena, &job});
  while (!job.is_cancelled()) {
    const std::size_t index = job.next.fetch_add(1, std::memory_order_relaxed);
    if (index >= job.count) return;
    try {
      job.work(index);
    } catch (...) {
      job.is_stopped.store(true, std::memory_order_relaxed);
      const Lock lock(mutex_);
      if (!job.thrown) job.thrown = std::current_exception();
    }
  }
  job.next.store(job.count, std::memory_order_relaxed);  // nobody need come
}

void ThreadPool::finish(Job& job) {
  work_on(job);
  Lock lock(mutex_);
  std::erase(open_, &job);
  while (job.num_helpers.load(std::memory_order_acquire) > 0) {
    if (Job* const inner = find_job_inside(job)) {
      help(*inner, lock);
    } else {
      wait_for_change(job, lock);
    }
  }
  lock.unlock();
  if (job.thrown) std::rethrow_exception(job.thrown);
}

// Until the job has fewer helpers, or there may be another one inside.
void ThreadPool::wait_for_change(const Job& job, Lock& lock) {
  const unsigned seen = num_opened_.load(std::memory_order_relaxed);
  const auto has_changed = [&] {
    return job.num_helpers.load(std::memory_order_acquire) == 0 ||
           num_opened_.load(std::memory_order_relaxed) != seen;
  };
  lock.unlock();
  spin_until(has_changed);
  lock.lock();
  ++num_waiting_;
  changed_.wait(lock, has_changed);
  --num_waiting_;
}

}  // namespace weft::pool
