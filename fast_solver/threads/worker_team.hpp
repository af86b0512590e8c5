#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <weft/core/parallel/task_group.hpp>

namespace weft::fast {

/// Threads that share the parallel loops of one solve. Such a loop takes about ten microseconds, which is less than another
/// thread needs to find a task. Therefore workers spin between loops.
///
/// Workers are tasks of a TaskGroup. They join when a thread is available, and without any the caller does all the work. Each thread
/// has the same parts in every loop, because their data are in its cache. The caller claims the parts of a worker that does not
/// begin. The result of a part must not depend on the thread that computes it.
///
/// The operating system may suspend a worker in the middle of a part, and the caller has to wait for it. If that costs more
/// than workers gain, the team falls back to the caller's thread only for a while, each time for longer.
///
/// While a team is open its caller must not wait for other tasks, because it might be given a worker's task.
class WorkerTeam {
 public:
  /// Parts of a loop at most.
  static constexpr int kMostParts = 64;

  WorkerTeam() = default;
  WorkerTeam(const WorkerTeam&) = delete;
  WorkerTeam& operator=(const WorkerTeam&) = delete;
  WorkerTeam(WorkerTeam&&) = delete;
  WorkerTeam& operator=(WorkerTeam&&) = delete;
  ~WorkerTeam() { close(); }

  /// Open as long as the outermost of them exists, unless workers were stopped lately; only one thread at a time may use a
  /// team. num_threads: with the caller's, at most.
  class Scope {
   public:
    Scope(WorkerTeam& team, int num_threads) : team_(team) {
      if (team_.num_scopes_++ == 0) team_.open(num_threads);
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    Scope(Scope&&) = delete;
    Scope& operator=(Scope&&) = delete;
    ~Scope() {
      if (--team_.num_scopes_ == 0) team_.close();
    }

   private:
    WorkerTeam& team_;
  };

  /// Closed as long as the result exists, for work that waits for other tasks; then open if it was, unless workers
  /// were stopped lately.
  class Pause {
   public:
    explicit Pause(WorkerTeam& team) : team_(team), num_threads_(team.num_threads()) {
      team_.close();
    }
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;
    Pause(Pause&&) = delete;
    Pause& operator=(Pause&&) = delete;
    ~Pause() {
      if (num_threads_ > 1) team_.open(num_threads_);
    }

   private:
    WorkerTeam& team_;
    int num_threads_;
  };

  [[nodiscard]] int num_threads() const { return num_threads_; }

  /// work(part) for each of num_parts parts, at most kMostParts; returns when all are done. What work throws ends the
  /// program: others may be at work on the same. Workers get a copy of a work that is small and trivial to copy: what it
  /// has by value they need not fetch from the caller's stack, line after line of the cache.
  template <class Work>
  void run(int num_parts, const Work& work) noexcept {
    if (num_threads_ <= 1 || num_parts <= 1) {
      for (int part = 0; part < num_parts; ++part) work(part);
      return;
    }
    if constexpr (std::is_trivially_copyable_v<Work> && sizeof(Work) <= sizeof(Job)) {
      Job job{};
      std::memcpy(job.data(), &work, sizeof(Work));
      run_shared(num_parts, &call_copy<Work>, job, static_cast<int>(kWords<Work>));
    } else {
      run_shared(num_parts, &call_original<Work>, {std::bit_cast<std::uintptr_t>(&work)}, 1);
    }
  }

 private:
  /// The work of a loop for a worker: a copy, or its address.
  using Job = std::array<std::uint64_t, 13>;
  using Call = void (*)(const Job& job, int part) noexcept;
  static constexpr std::uint64_t kNone = 0;
  /// [s] What a team that has been good for long may lose to stopped workers before its caller does without them.
  static constexpr double kMostBudget = 20e-3;
  template <class Work>
  static constexpr std::size_t kWords = (sizeof(Work) + sizeof(Job::value_type) - 1) /
                                        sizeof(Job::value_type);
  template <class Work>
  static void call_copy(const Job& job, int part) noexcept {
    std::array<std::byte, sizeof(Work)> bytes;
    std::memcpy(bytes.data(), job.data(), sizeof(Work));
    std::bit_cast<Work>(bytes)(part);
  }
  template <class Work>
  static void call_original(const Job& job, int part) noexcept {
    (*std::bit_cast<const Work*>(static_cast<std::uintptr_t>(job[0])))(part);
  }
  /// The present loop. In one line of the cache but for a large job, so that who waits for its number has the rest as
  /// well. While the rest is written the number is kNone; who has read it looks at the number again.
  struct alignas(128) Loop {
    std::atomic<std::uint64_t> number{kNone};
    std::atomic<Call> call{nullptr};
    std::atomic<int> num_parts{0};
    std::atomic<int> num_words{0};  ///< for the job
    std::array<std::atomic<std::uint64_t>, std::tuple_size_v<Job>> job{};
  };
  static_assert(sizeof(Loop) == 128);
  /// The last loop in which somebody has taken a part. Each has a cache line.
  struct alignas(64) Claim {
    std::atomic<std::uint64_t> loop{0};
  };

  /// Calls for workers.
  void open(int num_threads);
  /// Sends them away. Without effect on a team that is not open.
  void close();
  void run_shared(int num_parts, Call call, const Job& job, int num_words);
  void run_worker();
  void work_on_loop(std::uint64_t loop, int member);
  bool claim_part(std::uint64_t loop, int part);
  /// The first of the parts that a member begins with. The caller is number 0, whose parts nobody else takes; it has the odd one, for
  /// it is there first.
  [[nodiscard]] int first_part(int member, int num_parts) const {
    return (num_parts * member + num_threads_ - 1) / num_threads_;
  }
  [[nodiscard]] std::uint64_t parts_of(int member, int num_parts) const;  ///< flags
  [[nodiscard]] int num_present();
  [[nodiscard]] std::uint64_t awaited_parts(int num_parts);  ///< flags
  /// taken_parts: flags of those of workers that the caller has taken.
  void note_absent(int num_parts, std::uint64_t taken_parts);
  void update_fallback();

  Loop loop_;
  std::uint64_t num_loops_ = 0;
  std::uint64_t num_done_before_ = 0;  ///< num_done_ after the last loop
  alignas(64) std::atomic<bool> is_open_{false};
  std::atomic<int> num_workers_{0};                     ///< workers that have joined
  alignas(64) std::atomic<std::uint64_t> num_done_{0};  ///< parts of all loops, by workers
  std::array<Claim, kMostParts> claims_;
  int num_scopes_ = 0;
  int num_threads_ = 1;
  std::uint64_t absent_ = 0;   ///< flags of members
  int looks_for_arrival_ = 0;  ///< polls that are left
  std::chrono::steady_clock::time_point opened_;
  double lost_ = 0;              ///< since then, in waiting for stopped workers [s]
  double budget_ = kMostBudget;  ///< gained by workers over lost, at most kMostCredit [s]
  int num_serial_ = 0;           ///< times to be opened without workers
  int next_serial_ = 0;          ///< the same when the budget is used up
  int num_good_ = 0;             ///< times open with budget left since next_serial_ has changed
  TaskGroup workers_{TaskGroup::Place::kHere};
};

}  // namespace weft::fast
