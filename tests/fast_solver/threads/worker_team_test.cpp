#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <numeric>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <weft/core/parallel/parallel_for.hpp>
#include <weft/core/parallel/threads.hpp>
#include <weft/fast_solver/threads/worker_team.hpp>

namespace weft::fast {
namespace {

// Each loop reads what all parts of the one before have written.
std::vector<long> chain(WorkerTeam& team, int num_parts, int num_loops) {
  const auto n = static_cast<std::size_t>(num_parts);
  std::array<std::vector<long>, 2> values = {std::vector<long>(n, 1), std::vector<long>(n, 0)};
  for (int loop = 0; loop < num_loops; ++loop) {
    const std::vector<long>& from = values[static_cast<std::size_t>(loop % 2)];
    std::vector<long>& to = values[static_cast<std::size_t>(1 - loop % 2)];
    team.run(num_parts, [&](int part) {
      const auto p = static_cast<std::size_t>(part);
      to[p] = (from[p] + 3 * from[(p + 1) % n] + 7 * from[(p + n / 2) % n]) % 1000003;
    });
  }
  return values[static_cast<std::size_t>(num_loops % 2)];
}

TEST(WorkerTeam, DoesAllPartsAndLoopsInOrder) {
  WorkerTeam alone;
  for (const int num_parts : {1, 2, 3, 7, 64}) {
    const std::vector<long> expected = chain(alone, num_parts, 3000);
    for (const int num_threads : {1, 2, 3, 8}) {
      WorkerTeam team;
      const WorkerTeam::Scope scope(team, num_threads);
      EXPECT_EQ(chain(team, num_parts, 3000), expected) << num_threads << " threads";
    }
  }
}

TEST(WorkerTeam, DoesNoPartTwice) {
  WorkerTeam team;
  const WorkerTeam::Scope scope(team, 4);
  std::array<std::atomic<int>, WorkerTeam::kMostParts> counts{};
  for (int loop = 1; loop <= 2000; ++loop) {
    const int num_parts = 1 + loop % WorkerTeam::kMostParts;
    for (auto& count : counts) count = 0;
    team.run(num_parts, [&](int part) { ++counts[static_cast<std::size_t>(part)]; });
    for (int part = 0; part < WorkerTeam::kMostParts; ++part) {
      ASSERT_EQ(counts[static_cast<std::size_t>(part)], part < num_parts ? 1 : 0) << loop;
    }
  }
}

/// Not part of the work, whose size matters.
std::atomic<bool> parts_sleep = false;

// Each loop has other values, and what they are is known to nobody but its work; until a worker has done a part.
template <class Value, class Make>
void expect_work_arrives(const Make& make) {
  with_threads(2, [&] {
    WorkerTeam team;
    const WorkerTeam::Scope scope(team, 2);
    std::array<long, 8> sums{};
    std::array<std::thread::id, 8> by{};
    bool is_helped = false;
    for (long loop = 0; loop < 2000 || (!is_helped && loop < 6000); ++loop) {
      // On a busy machine all is done before a helper gets there: parts that sleep leave it their processor.
      parts_sleep = loop >= 2000;
      const Value values = make(loop);
      team.run(8, [values, to = sums.data(), who = by.data()](int part) {
        if (parts_sleep) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        to[part] = std::accumulate(values.begin(), values.end(), static_cast<long>(part));
        who[part] = std::this_thread::get_id();
      });
      for (std::size_t part = 0; part < sums.size(); ++part) {
        const auto size = static_cast<long>(values.size());
        ASSERT_EQ(sums[part], static_cast<long>(part) + size * loop);
        is_helped = is_helped || by[part] != std::this_thread::get_id();
      }
    }
    EXPECT_TRUE(is_helped);
  });
}

template <std::size_t kSize>
void expect_work_of_size_arrives() {
  using Values = std::array<long, kSize>;
  expect_work_arrives<Values>([](long value) {
    Values values;
    values.fill(value);
    return values;
  });
}

TEST(WorkerTeam, HelpersGetWorkOfAnySize) {
  expect_work_of_size_arrives<1>();
  expect_work_of_size_arrives<5>();
  expect_work_of_size_arrives<11>();  // the most of which there is a copy
  expect_work_of_size_arrives<12>();
  expect_work_of_size_arrives<100>();
}

TEST(WorkerTeam, HelpersGetWorkThatIsNotTrivialToCopy) {
  expect_work_arrives<std::vector<long>>([](long value) { return std::vector<long>(3, value); });
}

// The first part waits for somebody else to begin the second, in one of many loops: a worker may come late.
TEST(WorkerTeam, IsHelped) {
  bool is_helped = false;
  with_threads(2, [&] {
    WorkerTeam team;
    const WorkerTeam::Scope scope(team, 2);
    for (int loop = 0; loop < 1000 && !is_helped; ++loop) {
      std::atomic<bool> has_begun = false;
      const std::thread::id caller = std::this_thread::get_id();
      team.run(2, [&](int part) {
        if (part == 1) {
          has_begun = std::this_thread::get_id() != caller;
          return;
        }
        const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(5);
        while (!has_begun && std::chrono::steady_clock::now() < end) std::this_thread::yield();
      });
      is_helped = has_begun;
    }
  });
  EXPECT_TRUE(is_helped);
}

/// Has a worker that takes .4 s for a part, as one that other programs have stopped.
void let_down(WorkerTeam& team) {
  const WorkerTeam::Scope scope(team, 2);
  std::atomic<bool> was_helper = false;
  const std::thread::id caller = std::this_thread::get_id();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (!was_helper && std::chrono::steady_clock::now() < end) {
    team.run(2, [&](int part) {
      if (part == 1 && std::this_thread::get_id() != caller) {
        was_helper = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
      }
    });
  }
}

int times_alone(WorkerTeam& team) {
  for (int count = 0;; ++count) {
    const WorkerTeam::Scope scope(team, 2);
    const WorkerTeam::Scope inner(team, 2);  // does not count
    if (team.num_threads() == 2) return count;
  }
}

/// After a stop that the caller has noticed: it may have been stopped itself.
int times_alone_after_stop(WorkerTeam& team) {
  for (int attempt = 0; attempt < 5; ++attempt) {
    let_down(team);
    if (const int times = times_alone(team); times > 0) return times;
  }
  return 0;
}

TEST(WorkerTeam, IsAloneTwiceAsOftenAfterEachStop) {
  with_threads(2, [&] {
    WorkerTeam team;
    EXPECT_EQ(times_alone(team), 0);
    for (const int expected : {8, 16, 32}) EXPECT_EQ(times_alone_after_stop(team), expected);
    for (int time = 0; time < 1000; ++time) {  // without a stop: as at first
      const WorkerTeam::Scope scope(team, 2);
    }
    EXPECT_EQ(times_alone_after_stop(team), 8);
  });
}

TEST(WorkerTeam, CanBeOpenedAgain) {
  WorkerTeam alone;
  const std::vector<long> expected = chain(alone, 4, 5);
  WorkerTeam team;
  for (int time = 0; time < 500; ++time) {
    const WorkerTeam::Scope scope(team, 1 + time % 3);
    ASSERT_EQ(chain(team, 4, 5), expected) << time;
  }
}

TEST(WorkerTeam, IsOpenAgainAfterAPause) {
  WorkerTeam alone;
  const std::vector<long> expected = chain(alone, 4, 200);
  WorkerTeam team;
  {
    const WorkerTeam::Pause pause(team);  // For a team that is not open
  }
  EXPECT_EQ(team.num_threads(), 1);
  const WorkerTeam::Scope scope(team, 3);
  EXPECT_EQ(team.num_threads(), 3);
  int num_open = 0;  // not where a worker was stopped in a part
  for (int time = 0; time < 100; ++time) {
    {
      const WorkerTeam::Pause pause(team);
      ASSERT_EQ(team.num_threads(), 1);
      std::atomic<int> sum = 0;
      parallel_for(10, [&](std::size_t i) { sum += static_cast<int>(i); });
      ASSERT_EQ(sum, 45);
    }
    num_open += team.num_threads() == 3 ? 1 : 0;
    ASSERT_EQ(chain(team, 4, 200), expected) << time;
  }
  EXPECT_GT(num_open, 0);
}

// A worker that comes before the first loop may not look at the last one of the time before, when the caller had more parts
// of its own.
TEST(WorkerTeam, BeginsNothingOfTheTimeBefore) {
  with_threads(4, [] {
    WorkerTeam team;
    std::array<std::atomic<int>, 10> counts{};
    int expected = 0;
    const auto count = [&counts](int part) { ++counts[static_cast<std::size_t>(part)]; };
    for (int again = 0; again < 200; ++again) {
      for (const int num_threads : {2, 3, 4}) {
        const WorkerTeam::Scope scope(team, num_threads);
        std::this_thread::sleep_for(std::chrono::microseconds(200));
        team.run(5, count);
        ++expected;
        for (int part = 0; part < 5; ++part) {
          ASSERT_EQ(counts[static_cast<std::size_t>(part)], expected) << "part " << part;
        }
      }
    }
  });
}

TEST(WorkerTeam, NeedsNoHelper) {
  with_threads(1, [] {
    WorkerTeam team;
    const WorkerTeam::Scope scope(team, 4);
    WorkerTeam alone;
    EXPECT_EQ(chain(team, 8, 100), chain(alone, 8, 100));
  });
}

TEST(WorkerTeam, ManyWorkAtTheSameTime) {
  WorkerTeam alone;
  const std::vector<long> expected = chain(alone, 6, 300);
  std::array<std::vector<long>, 10> results;
  parallel_for(results.size(), [&](std::size_t i) {
    WorkerTeam team;
    const WorkerTeam::Scope scope(team, 3);
    results[i] = chain(team, 6, 300);
  });
  for (const std::vector<long>& result : results) EXPECT_EQ(result, expected);
}

}  // namespace
}  // namespace weft::fast
