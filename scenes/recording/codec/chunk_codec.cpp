#include <weft/scenes/recording/codec/chunk_codec.hpp>

#include <fmt/core.h>
#include <zstd.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

/// zstd's default: higher levels gain a few percent of size for a multiple of the time.
constexpr int kCompressionLevel = 3;

/// Byte k of scalar i goes to place k * num_scalars + i.
std::vector<std::byte> shuffle(std::span<const std::byte> from, std::size_t scalar_bytes) {
  std::vector<std::byte> to(from.size());
  const std::size_t num_scalars = from.size() / scalar_bytes;
  for (std::size_t k = 0; k < scalar_bytes; ++k) {
    for (std::size_t i = 0; i < num_scalars; ++i) {
      to[k * num_scalars + i] = from[i * scalar_bytes + k];
    }
  }
  return to;
}

std::vector<std::byte> unshuffle(std::span<const std::byte> from, std::size_t scalar_bytes) {
  std::vector<std::byte> to(from.size());
  const std::size_t num_scalars = from.size() / scalar_bytes;
  for (std::size_t k = 0; k < scalar_bytes; ++k) {
    for (std::size_t i = 0; i < num_scalars; ++i) {
      to[i * scalar_bytes + k] = from[k * num_scalars + i];
    }
  }
  return to;
}

}  // namespace

std::vector<std::byte> compress_chunk(std::span<const std::byte> raw, std::size_t scalar_bytes) {
  const std::vector<std::byte> bytes = shuffle(raw, scalar_bytes);
  std::vector<std::byte> data(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(data.data(), data.size(), bytes.data(), bytes.size(), kCompressionLevel);
  if (ZSTD_isError(size) != 0) {
    throw Error(fmt::format("cannot compress: {}", ZSTD_getErrorName(size)));
  }
  data.resize(size);
  return data;
}

std::vector<std::byte> decompress_chunk(std::span<const std::byte> data, std::size_t raw_bytes,
                                        std::size_t scalar_bytes) {
  // Asked before memory is reserved, so that a wrong number cannot ask for all of it.
  if (ZSTD_getFrameContentSize(data.data(), data.size()) != raw_bytes) {
    throw Error(fmt::format("not {} compressed bytes", raw_bytes));
  }
  std::vector<std::byte> bytes(raw_bytes);
  const std::size_t size = ZSTD_decompress(bytes.data(), bytes.size(), data.data(), data.size());
  if (ZSTD_isError(size) != 0 || size != raw_bytes) {
    throw Error("cannot decompress");
  }
  return unshuffle(bytes, scalar_bytes);
}

}  // namespace weft::scenes
