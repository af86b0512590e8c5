#include <weft/core/trace.hpp>

#include <algorithm>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/custom_forces/law_set.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft {
namespace {

const TraceThread* thread_named(const std::vector<TraceThread>& threads, const std::string& name) {
  for (const TraceThread& thread : threads) {
    if (thread.name == name) return &thread;
  }
  return nullptr;
}

TEST(Trace, RecordsNothingUntilStartedAndAfterStopped) {
  { const TraceScope before("before"); }
  start_trace();
  { const TraceScope inside("inside"); }
  const std::vector<TraceThread> threads = stop_trace();
  { const TraceScope after("after"); }
  ASSERT_EQ(threads.size(), 1U);
  ASSERT_EQ(threads[0].events.size(), 1U);
  EXPECT_EQ(threads[0].events[0].name, "inside");
  EXPECT_TRUE(stop_trace().empty());
}

TEST(Trace, AScopeBegunBeforeTheTraceIsLeftOut) {
  start_trace();
  {
    const TraceScope early("early");
    start_trace();
  }
  EXPECT_TRUE(stop_trace().empty());
}

TEST(Trace, NamesThreadsAndNestsTheirEvents) {
  start_trace();
  std::thread other([] {
    name_trace_thread("other");
    const TraceScope outer("outer");
    const TraceScope inner("inner");
  });
  other.join();
  { const TraceScope here("here"); }
  const std::vector<TraceThread> threads = stop_trace();
  const TraceThread* thread = thread_named(threads, "other");
  ASSERT_NE(thread, nullptr);
  ASSERT_EQ(thread->events.size(), 2U);
  const TraceEvent& inner = thread->events[0];
  const TraceEvent& outer = thread->events[1];
  EXPECT_EQ(inner.name, "inner");
  EXPECT_LE(0, outer.begin);
  EXPECT_LE(outer.begin, inner.begin);
  EXPECT_LE(inner.begin, inner.end);
  EXPECT_LE(inner.end, outer.end);
  EXPECT_NE(thread_named(threads, "worker 1"), nullptr) << "this thread has no name";
}

TEST(Trace, ChunksOfALawLieInsideTheLaw) {
  const ClothMesh mesh = make_cloth_grid({.nodes = {40, 40}});
  forces::LawSet<double> laws;
  laws.add(forces::make_law<double>({"tension", {}, {{"stiffness", {100.0}}}}, mesh));
  const Matrix3X<double> velocities = Matrix3X<double>::Zero(3, mesh.num_nodes());
  Matrix3X<double> forces = velocities;
  start_trace();
  (void)laws.add_forces({mesh.rest_positions, velocities, mesh.masses},
                        forces::LawSet<double>::VelocityLaws::kAsForces, forces);
  const std::vector<TraceThread> threads = stop_trace();
  TraceEvent law{};
  int num_laws = 0;
  int num_chunks = 0;
  for (const TraceThread& thread : threads) {
    for (const TraceEvent& event : thread.events) {
      if (event.name == "tension") {
        law = event;
        ++num_laws;
      }
    }
  }
  ASSERT_EQ(num_laws, 1);
  for (const TraceThread& thread : threads) {
    for (const TraceEvent& event : thread.events) {
      if (event.name != "chunk") continue;
      ++num_chunks;
      EXPECT_GE(event.begin, law.begin);
      EXPECT_LE(event.end, law.end);
    }
  }
  EXPECT_GE(num_chunks, 4);
}

TEST(Trace, ChromeTraceIsWrittenToTheNanosecondAndEscaped) {
  const std::vector<TraceThread> threads = {{"a \"b\"\n", {{"work", 1001, 2003004}}}};
  std::ostringstream out;
  write_chrome_trace(threads, out);
  EXPECT_EQ(out.str(),
            "{\"displayTimeUnit\": \"ms\", \"traceEvents\": [\n"
            R"({"ph": "M", "pid": 1, "tid": 0, "name": "thread_name", )"
            R"("args": {"name": "a \"b\"\u000a"}},)"
            "\n"
            R"({"ph": "X", "pid": 1, "tid": 0, "name": "work", "ts": 1.001, "dur": 2002.003})"
            "\n]}\n");
}

}  // namespace
}  // namespace weft
