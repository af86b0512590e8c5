// Runs a target on files, and on all files of folders, where there is no libFuzzer.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <weft/core/input_file.hpp>
#include "fuzz/fuzz_target.hpp"

namespace {

std::vector<std::filesystem::path> files_of(int argc, char** argv) {
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < argc; ++i) {
    if (!std::filesystem::is_directory(argv[i])) {
      files.emplace_back(argv[i]);
      continue;
    }
    for (const auto& entry : std::filesystem::directory_iterator(argv[i])) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::filesystem::path> files = files_of(argc, argv);
    if (files.empty()) {
      std::fprintf(stderr, "usage: %s FILE_OR_FOLDER...; there is no file\n", argv[0]);
      return 2;
    }
    for (const std::filesystem::path& file : files) {
      const std::string bytes = weft::read_input_file(file);
      std::printf("%s, %zu bytes\n", file.c_str(), bytes.size());
      std::fflush(stdout);  // the last line names the input that ends the process
      LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
