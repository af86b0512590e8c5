#include <weft/bridge/bullet/bullet_guard.hpp>

#ifdef __ELF__
#include <link.h>
#endif

#include <string>
#include <string_view>

#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

struct LoadedLibraries {
  bool single_precision = false;
  bool double_precision = false;
};

#ifdef __ELF__
int note_library(dl_phdr_info* info, std::size_t /*size*/, void* data) {
  auto& loaded = *static_cast<LoadedLibraries*>(data);
  const std::string_view path = info->dlpi_name;
  const std::string_view name = path.substr(path.rfind('/') + 1);
  if (name.starts_with("libBulletSoftBody-float64.so")) loaded.double_precision = true;
  if (name.starts_with("libBulletSoftBody.so")) loaded.single_precision = true;
  return 0;
}

LoadedLibraries loaded_libraries() {
  LoadedLibraries loaded;
  dl_iterate_phdr(&note_library, &loaded);
  return loaded;
}
#else
// A program of Windows says of each function which library it comes from: two of them do not get into each other's way.
LoadedLibraries loaded_libraries() {
  return {};
}
#endif

std::string describe(const BulletLayout& layout) {
  return "Bullet " + std::to_string(layout.version) + ", btScalar of " +
         std::to_string(layout.scalar_size) + " bytes, btSoftBody of " +
         std::to_string(layout.soft_body_size) + " bytes, Node of " +
         std::to_string(layout.node_size) + " bytes";
}

}  // namespace

const char* precision_name() {
  return sizeof(btScalar) == 8 ? "float64" : "float32";
}

void require_matching_bullet(const BulletLayout& caller) {
  const BulletLayout own = bullet_layout_here();
  if (caller.scalar_size != own.scalar_size || caller.soft_body_size != own.soft_body_size ||
      caller.node_size != own.node_size || caller.version != own.version) {
    throw Error("bridge: this program was compiled for " + describe(caller) +
                ", but the bridge for " + describe(own) +
                "; compile and link both for one Bullet (weft::bridge or weft::bridge_float64)");
  }
  const LoadedLibraries loaded = loaded_libraries();
  if (loaded.single_precision && loaded.double_precision) {
    throw Error(
        "bridge: libBulletSoftBody and libBulletSoftBody-float64 are both loaded in this process; "
        "they export the same symbols with different layouts, expected one of them");
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
