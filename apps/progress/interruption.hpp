#pragma once

#include <string>

#include <weft/core/error.hpp>

namespace weft::app {

/// A signal asked for the end of the work; what was done so far is kept.
class Interrupted : public Error {
 public:
  Interrupted(int signal, const std::string& message) : Error(message), signal_(signal) {}
  [[nodiscard]] int signal() const { return signal_; }

 private:
  int signal_;
};

/// While it lives, SIGINT (Ctrl-C), SIGTERM and SIGHUP do not end the process but are noted, so that
/// it can keep its work; the same signal once more ends it at once. A signal that the caller has
/// ignored, as nohup does, stays ignored. One at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// @throws Interrupted if there was a signal.
  static void check();
};

}  // namespace weft::app
