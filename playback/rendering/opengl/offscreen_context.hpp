#pragma once

#include <memory>
#include <string>

namespace weft::scenes {

/// An OpenGL core profile context without a window. Everything that draws is written against this
/// interface, so that the library that opens the context can be exchanged.
class OffscreenContext {
 public:
  using Function = void (*)();

  virtual ~OffscreenContext() = default;

  /// Makes the context the current one of the calling thread. Throws Error if that fails.
  virtual void make_current() = 0;

  /// Address of an OpenGL function, nullptr if there is none.
  [[nodiscard]] virtual Function find_function(const char* name) const = 0;

  /// For messages and logs: which library opened it.
  [[nodiscard]] virtual std::string description() const = 0;
};

struct GlVersion {
  int major = 3;
  int minor = 3;
};

/// Opens a context on OSMesa: a software renderer, no display and no graphics card needed.
/// Throws Error if the version is not available.
[[nodiscard]] std::unique_ptr<OffscreenContext> open_offscreen_context(GlVersion version = {});

}  // namespace weft::scenes
