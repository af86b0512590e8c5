// make_sample_report FOLDER: writes the sample reports that the page test opens.
#include <cstdio>
#include <exception>
#include <filesystem>

#include <weft/validation/report/write.hpp>

#include "tests/validation/report/sample_report.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_sample_report FOLDER\n", stderr);
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    weft::validation::write_report(weft::tests::sample_report(), folder / "failing");
    weft::validation::write_report(weft::tests::passing_report(), folder / "passing");
    weft::validation::write_report(weft::tests::deviating_report(), folder / "deviations");
    weft::validation::Report empty;
    empty.title = "Empty";
    weft::validation::write_report(empty, folder / "empty");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
