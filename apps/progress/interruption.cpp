#include "apps/progress/interruption.hpp"

#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <string_view>

namespace weft::app {
namespace {

constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t noted = 0;

void note(int signal) {
  noted = signal;
  static constexpr std::string_view kText =
      "\nweft: stopping at the end of this step; the same signal again stops at once\n";
  const int saved = errno;
  const ssize_t told = ::write(STDERR_FILENO, kText.data(), kText.size());
  errno = told < 0 ? saved : errno;
}

void set_handlers(void (*handler)(int), int flags) {
  for (const int signal : kSignals) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    if (now.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = flags;
    sigaction(signal, &action, nullptr);
  }
}

}  // namespace

Interruption::Interruption() {
  noted = 0;
  set_handlers(note, SA_RESTART | static_cast<int>(SA_RESETHAND));
}

Interruption::~Interruption() {
  set_handlers(SIG_DFL, 0);
}

void Interruption::check() {
  const int signal = noted;
  if (signal == 0) return;
  throw Interrupted(signal, std::string("stopped by signal ") + std::to_string(signal) + " (" +
                                strsignal(signal) + ")");
}

}  // namespace weft::app
