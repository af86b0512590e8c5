#pragma once

// Tested by tests/core/parallel/parallel_for_test.cpp.

#include <concepts>
#include <cstddef>

namespace weft {

/// The work that is done for an index: a reference to a function object, which has to outlive it. The compiled library runs it
/// without knowing its type, so that no header of Weft depends on the library that provides the threads.
class IndexWork {
 public:
  using Call = void (*)(const void* object, std::size_t index);

  IndexWork(const void* object, Call call) : object_(object), call_(call) {}
  template <std::invocable<std::size_t> Work>
  requires(!std::same_as<Work, IndexWork>) explicit IndexWork(const Work& work)
      : IndexWork(&work, [](const void* object, std::size_t index) {
          (*static_cast<const Work*>(object))(index);
        }) {}

  void operator()(std::size_t index) const { call_(object_, index); }

 private:
  const void* object_;
  Call call_;
};

}  // namespace weft
