#include <weft/scenes/recording/mark.hpp>

#include <array>

#include <fmt/core.h>

#include <weft/core/error.hpp>

namespace weft::scenes {

std::string_view mark_word(MarkKind kind) {
  constexpr std::array<std::string_view, 3> kWords = {"points", "lines", "arrows"};
  return kWords.at(static_cast<std::size_t>(kind));
}

void check_mark(const Mark& mark) {
  if (mark.name.empty()) {
    throw InvalidArgument(fmt::format("{}: have no name, expected one", mark_word(mark.kind)));
  }
  const Eigen::Index expected = mark.kind == MarkKind::kPoints ? 0 : mark.from.cols();
  if (mark.to.cols() != expected) {
    throw InvalidArgument(fmt::format("{} '{}': {} ends, expected {}", mark_word(mark.kind),
                                      mark.name, mark.to.cols(), expected));
  }
}

}  // namespace weft::scenes
