#include <weft/characters/name_list.hpp>

#include <weft/core/error.hpp>

namespace weft::characters {

void refuse_name(const std::string& what, const std::string& name,
                 const std::vector<std::string>& names) {
  constexpr std::size_t kMostShown = 20;
  std::string list;
  std::size_t count = 0;
  for (const std::string& known : names) {
    if (known.empty()) continue;
    if (++count <= kMostShown) list += (list.empty() ? "'" : ", '") + known + "'";
  }
  if (count > kMostShown) list += " and " + std::to_string(count - kMostShown) + " more";
  throw InvalidArgument("unknown " + what + " '" + name + "', " +
                        (count == 0 ? "the model has none" : "expected one of " + list));
}

}  // namespace weft::characters
