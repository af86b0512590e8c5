#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <type_traits>

#include <weft/core/parallel/index_work.hpp>

namespace weft {

/// Tasks that other threads begin while the caller goes on. Those that no thread has begun by then are done by wait().
///
/// One thread at a time may call the members. Tasks may have loops of their own, which wait() takes part in.
class TaskGroup {
 public:
  enum class Place {
    /// By the threads of the caller's loops. It has to be waited for before the loop or with_threads() ends in which it was started.
    kHere,
    /// By as many threads in a group of their own: loops of the caller neither wait for these tasks nor take them up.
    kApart,
  };

  explicit TaskGroup(Place place);
  TaskGroup(const TaskGroup&) = delete;
  TaskGroup& operator=(const TaskGroup&) = delete;
  TaskGroup(TaskGroup&&) = delete;
  TaskGroup& operator=(TaskGroup&&) = delete;
  /// Cancels what is not done and waits for what has begun.
  ~TaskGroup();

  /// task(i) for each i < count, once what was started before is waited for. Allocates nothing but what oneTBB does.
  template <class Task>
  void start(std::size_t count, Task task) {
    static_assert(std::is_trivially_copyable_v<Task> && sizeof(Task) <= sizeof(Stored),
                  "a task is copied: let it capture a pointer and no more");
    wait();
    std::memcpy(task_.data(), &task, sizeof(Task));
    begin(count, {task_.data(), [](const void* stored, std::size_t index) {
                    (*static_cast<const Task*>(stored))(index);
                  }});
  }

  /// Returns when all tasks are done. Throws what a task has thrown, one exception if there are several.
  void wait();

  /// Tasks that have not begun are left out, and so is what loops of the others have not begun. wait() is still needed.
  void cancel();

 private:
  struct Implementation;
  using Stored = std::array<std::byte, sizeof(void*)>;

  void begin(std::size_t count, IndexWork work);

  alignas(void*) Stored task_{};
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace weft
