#include <weft/fast_solver/threads/worker_team.hpp>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

#include <weft/core/parallel/processor_pause.hpp>

namespace weft::fast {
namespace {

using Clock = std::chrono::steady_clock;

/// Looks before a thread lets others have the processor, and before the caller does what a worker ought to: some 20 us,
/// longer than what a solve does between two loops, or a part takes.
constexpr int kLooks = 400;
/// The same that the caller spends on waiting for workers that are still to come, before it begins what is theirs: some
/// 10 us. What they find in its cache later takes as long again.
constexpr int kLooksForArrival = 200;
/// The share of the time that a team is open that workers gain. Two threads take about 0.6 of the time of one.
constexpr double kGain = 0.5;
/// [s] What a team may lose right after it has come back.
constexpr double kLeastBudget = 2e-3;
/// How often a team is opened without workers when it has lost too much, at first and at most: four and some two hundred
/// steps of a single body, which opens it twice in each.
constexpr int kLeastSerial = 8;
constexpr int kMostSerial = 512;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Flags of the parts begin ... end - 1.
std::uint64_t flags(int begin, int end) {
  const auto below = [](int part) {
    return part < WorkerTeam::kMostParts ? (std::uint64_t{1} << part) - 1 : ~std::uint64_t{0};
  };
  return below(end) & ~below(begin);
}

class Patience {
 public:
  /// True if it is at an end.
  bool wait() {
    if (++looks_ <= kLooks) {
      pause_processor();
      return false;
    }
    std::this_thread::yield();
    return true;
  }

 private:
  int looks_ = 0;
};

}  // namespace

void WorkerTeam::open(int num_threads) {
  if (num_threads <= 1) return;
  if (num_serial_ > 0) {
    --num_serial_;
    return;
  }
  num_threads_ = std::min(num_threads, kMostParts);
  opened_ = Clock::now();
  lost_ = 0;
  absent_ = 0;
  looks_for_arrival_ = kLooksForArrival;
  num_workers_.store(0, std::memory_order_relaxed);
  // The last loop may be one of fewer threads, of whose caller's parts a worker of now would take some for its own.
  loop_.number.store(kNone, std::memory_order_relaxed);
  is_open_.store(true, std::memory_order_release);
  workers_.start(static_cast<std::size_t>(num_threads_ - 1), [this](std::size_t) { run_worker(); });
}

void WorkerTeam::close() {
  if (num_threads_ == 1) return;
  is_open_.store(false, std::memory_order_release);
  const Clock::time_point start = Clock::now();
  workers_.wait();  // for one that is stopped, too
  lost_ += seconds_since(start);
  num_threads_ = 1;
  update_fallback();
}

// A host that takes a processor away now and then costs less than workers gain; where other programs run all the time,
// every worker will be stopped.
void WorkerTeam::update_fallback() {
  const double gained = kGain * (seconds_since(opened_) - lost_);
  budget_ = std::min(kMostBudget, budget_ + gained - lost_);
  next_serial_ = std::max(next_serial_, kLeastSerial);
  if (budget_ < 0) {
    budget_ = kLeastBudget;
    num_serial_ = next_serial_;
    next_serial_ = std::min(2 * next_serial_, kMostSerial);
    num_good_ = 0;
  } else if (++num_good_ >= next_serial_) {
    next_serial_ /= 2;
    num_good_ = 0;
  }
}

void WorkerTeam::run_shared(int num_parts, Call call, const Job& job, int num_words) {
  const std::uint64_t loop = ++num_loops_;
  loop_.number.store(kNone, std::memory_order_relaxed);
  loop_.call.store(call, std::memory_order_release);
  loop_.num_parts.store(num_parts, std::memory_order_release);
  loop_.num_words.store(num_words, std::memory_order_release);
  for (std::size_t k = 0; k < static_cast<std::size_t>(num_words); ++k) {
    loop_.job[k].store(job[k], std::memory_order_release);
  }
  loop_.number.store(loop, std::memory_order_release);
  const int num_own = first_part(1, num_parts);
  int num_left = num_parts - num_own;
  std::uint64_t taken = 0;  // of workers
  const auto take = [&](int part) {
    if (!claim_part(loop, part)) return;
    call(job, part);
    --num_left;
    taken |= flags(part, part + 1);
  };
  for (int part = 0; part < num_own; ++part) call(job, part);  // which no worker takes
  const std::uint64_t awaited = awaited_parts(num_parts);
  // From the end: who comes now begins at the other one of what is its own.
  for (int part = num_parts - 1; part >= num_own; --part) {
    if ((awaited & flags(part, part + 1)) == 0) take(part);
  }
  Patience patience;
  std::optional<Clock::time_point> end_of_patience;
  while (num_done_.load(std::memory_order_acquire) !=
         num_done_before_ + static_cast<std::uint64_t>(num_left)) {
    if (!patience.wait()) continue;
    for (int part = num_own; part < num_parts; ++part) take(part);
    if (!end_of_patience) end_of_patience = Clock::now();
  }
  num_done_before_ += static_cast<std::uint64_t>(num_left);
  if (end_of_patience) lost_ += seconds_since(*end_of_patience);
  note_absent(num_parts, taken);
}

// The parts of workers that are there, or whose arrival is worth waiting for.
std::uint64_t WorkerTeam::awaited_parts(int num_parts) {
  const int num_present = this->num_present();
  std::uint64_t awaited = flags(first_part(1, num_parts), first_part(num_present, num_parts));
  for (int member = 1; member < num_present && absent_ != 0; ++member) {
    if ((absent_ & flags(member, member + 1)) != 0) awaited &= ~parts_of(member, num_parts);
  }
  return awaited;
}

// A worker that has left all that was its own to the caller does something else; once it takes a part, it is back.
void WorkerTeam::note_absent(int num_parts, std::uint64_t taken_parts) {
  if (absent_ == 0 && taken_parts == 0) return;
  for (int member = 1; member < num_threads_; ++member) {
    const std::uint64_t parts = parts_of(member, num_parts);
    const std::uint64_t flag = flags(member, member + 1);
    if (parts == 0) continue;
    absent_ = (taken_parts & parts) == parts ? absent_ | flag : absent_ & ~flag;
  }
}

std::uint64_t WorkerTeam::parts_of(int member, int num_parts) const {
  return flags(first_part(member, num_parts), first_part(member + 1, num_parts));
}

// With the caller, and those whose arrival it waits for.
int WorkerTeam::num_present() {
  while (true) {
    const int num_present = 1 + num_workers_.load(std::memory_order_acquire);
    if (num_present == num_threads_ || looks_for_arrival_ == 0) return num_present;
    --looks_for_arrival_;
    pause_processor();
  }
}

void WorkerTeam::run_worker() {
  std::uint64_t last = kNone;
  const int member = 1 + num_workers_.fetch_add(1, std::memory_order_acq_rel);
  Patience patience;
  while (is_open_.load(std::memory_order_acquire)) {
    const std::uint64_t loop = loop_.number.load(std::memory_order_acquire);
    if (loop == last || loop == kNone) {
      patience.wait();
      continue;
    }
    last = loop;
    work_on_loop(loop, member);
    patience = {};
  }
}

// A loop that is over by now has no part left.
void WorkerTeam::work_on_loop(std::uint64_t loop, int member) {
  const Call call = loop_.call.load(std::memory_order_acquire);
  const int num_parts = loop_.num_parts.load(std::memory_order_acquire);
  const int num_words = loop_.num_words.load(std::memory_order_acquire);
  Job job{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(num_words); ++k) {
    job[k] = loop_.job[k].load(std::memory_order_acquire);
  }
  if (loop_.number.load(std::memory_order_acquire) != loop) return;
  int num_done = 0;
  const auto take = [&](int begin, int end) {
    for (int part = begin; part < end; ++part) {
      if (!claim_part(loop, part)) continue;
      call(job, part);
      ++num_done;
    }
  };
  take(first_part(member, num_parts), first_part(member + 1, num_parts));
  const int num_present = 1 + num_workers_.load(std::memory_order_relaxed);
  take(first_part(num_present, num_parts), num_parts);  // of those that have not come
  if (num_done > 0) {
    num_done_.fetch_add(static_cast<std::uint64_t>(num_done), std::memory_order_release);
  }
}

bool WorkerTeam::claim_part(std::uint64_t loop, int part) {
  std::atomic<std::uint64_t>& claim = claims_[static_cast<std::size_t>(part)].loop;
  std::uint64_t taken = claim.load(std::memory_order_relaxed);
  return taken < loop && claim.compare_exchange_strong(taken, loop, std::memory_order_relaxed);
}

}  // namespace weft::fast
