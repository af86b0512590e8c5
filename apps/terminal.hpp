#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>

namespace weft::app {

/// The text as a terminal can show it without obeying it: control characters but line feed and tab,
/// marks that turn the direction of writing, and bytes that are not UTF-8 become "\x1b". Names of
/// files and bodies and the messages of libraries come from anybody.
[[nodiscard]] std::string printable(std::string_view text);

/// Writes printable(text). What goes wrong is told by finish_output().
void write_text(std::FILE* stream, std::string_view text);

/// Writes data, not a message: as it is, to anything but a terminal.
void write_data(std::FILE* stream, std::string_view data);

/// The commands print with these and with nothing else.
template <class... Args>
void print(std::FILE* stream, fmt::format_string<Args...> format, Args&&... args) {
  write_text(stream, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void print(fmt::format_string<Args...> format, Args&&... args) {
  write_text(stdout, fmt::format(format, std::forward<Args>(args)...));
}

/// Before anything is opened: no output file may get the number of a standard stream that the caller
/// has closed, and a file size limit is an error of one file and not the end of the process.
void prepare_output();

/// The exit code in the end: code, or kBadInput with a message if code is kOk and not all of standard
/// output could be written.
[[nodiscard]] int finish_output(int code);

}  // namespace weft::app
