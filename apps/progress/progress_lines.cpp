#include "apps/progress/progress_lines.hpp"

#include <unistd.h>

#include <cstdio>

#include "apps/terminal.hpp"

namespace weft::app {

ProgressLines::ProgressLines() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressLines::done(const std::string& kind, int number, int total,
                         const std::string& name) const {
  if (is_terminal_) return;
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  print(stderr, "{} {} of {}: {} ({:.1f} s)\n", kind, number, total, name, elapsed);
  std::fflush(stderr);
}

}  // namespace weft::app
