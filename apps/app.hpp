#pragma once

#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace weft::app {

/// Exit codes of the weft command.
inline constexpr int kOk = 0;
inline constexpr int kCaseFailed = 1;  ///< a validation case failed, or a simulation blew up
inline constexpr int kDifferent = 1;   ///< two recordings are not equal
inline constexpr int kUnsound = 1;     ///< a recording is damaged or has values that are not finite
inline constexpr int kBadInput = 2;    ///< command line, scene file, recording or output place
inline constexpr int kSignal = 128;    ///< plus the number of the signal that stopped it

/// Each command adds its options to the parser and returns what to do once they are parsed.
using Action = std::function<int()>;

/// The words the program was started with, for a command that hands over to another executable.
struct CommandLine {
  std::vector<std::string> words;
  std::filesystem::path executable;  ///< the file that runs
};

/// The reason that an error gives: its text, or the standard library's word for its kind.
[[nodiscard]] std::string reason_of(const std::exception& error);

[[nodiscard]] Action add_list_command(CLI::App& parser);
[[nodiscard]] Action add_run_command(CLI::App& parser, const CommandLine& command_line);
[[nodiscard]] Action add_validate_command(CLI::App& parser, const CommandLine& command_line);
[[nodiscard]] Action add_reference_command(CLI::App& parser);
[[nodiscard]] Action add_info_command(CLI::App& parser);
[[nodiscard]] Action add_diff_command(CLI::App& parser);
[[nodiscard]] Action add_trim_command(CLI::App& parser);
[[nodiscard]] Action add_verify_command(CLI::App& parser);
[[nodiscard]] Action add_view_command(CLI::App& parser, const CommandLine& command_line);
[[nodiscard]] Action add_render_command(CLI::App& parser);
[[nodiscard]] Action add_contact_sheet_command(CLI::App& parser);
[[nodiscard]] Action add_export_command(CLI::App& parser);
[[nodiscard]] Action add_import_command(CLI::App& parser);
[[nodiscard]] Action add_stability_command(CLI::App& parser);
[[nodiscard]] Action add_check_command(CLI::App& parser);
[[nodiscard]] Action add_check_mesh_command(CLI::App& parser);
[[nodiscard]] Action add_contact_table_command(CLI::App& parser);

}  // namespace weft::app
