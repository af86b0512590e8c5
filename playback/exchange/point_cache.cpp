#include <weft/playback/exchange/point_cache.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

static_assert(std::endian::native == std::endian::little, "PC2 files are little-endian");

constexpr std::string_view kSignature("POINTCACHE2\0", 12);
constexpr std::size_t kHeaderBytes = 32;
constexpr std::int32_t kVersion = 1;

template <class Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class Value>
Value read(std::string_view bytes, std::size_t offset) {
  Value value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

}  // namespace

std::string encode_point_cache(const PointCache& cache) {
  const Eigen::Index points = cache.samples.empty() ? 0 : cache.samples.front().cols();
  std::string bytes(kSignature);
  append(bytes, kVersion);
  append(bytes, static_cast<std::int32_t>(points));
  append(bytes, cache.first_frame);
  append(bytes, cache.frame_step);
  append(bytes, static_cast<std::int32_t>(cache.samples.size()));
  for (const Eigen::Matrix3Xf& sample : cache.samples) {
    if (sample.cols() != points) {
      throw InvalidArgument(
          fmt::format("encode_point_cache: a sample has {} points, expected {} "
                      "as the first one",
                      sample.cols(), points));
    }
    bytes.append(reinterpret_cast<const char*>(sample.data()),
                 static_cast<std::size_t>(sample.size()) * sizeof(float));
  }
  return bytes;
}

PointCache decode_point_cache(std::string_view bytes, const std::string& file) {
  if (bytes.substr(0, kSignature.size()) != kSignature) {
    throw Error(file + ": not a PC2 point cache, expected it to begin with POINTCACHE2");
  }
  if (bytes.size() < kHeaderBytes) {
    throw Error(fmt::format("{}: is cut off, {} bytes, expected a header of {}", file, bytes.size(),
                            kHeaderBytes));
  }
  const auto version = read<std::int32_t>(bytes, 12);
  if (version != kVersion) {
    throw Error(fmt::format("{}: PC2 version = {}, expected {}", file, version, kVersion));
  }
  const auto points = read<std::int32_t>(bytes, 16);
  const auto samples = read<std::int32_t>(bytes, 28);
  PointCache cache{read<float>(bytes, 20), read<float>(bytes, 24), {}};
  if (points < 1 || samples < 1) {
    throw Error(fmt::format("{}: {} points and {} samples, expected at least one of each", file,
                            points, samples));
  }
  if (!(cache.frame_step > 0) || !std::isfinite(cache.frame_step)) {
    throw Error(fmt::format("{}: frames per sample = {}, expected > 0", file, cache.frame_step));
  }
  const std::uint64_t sample_bytes = std::uint64_t{12} * static_cast<std::uint64_t>(points);
  const std::uint64_t expected = kHeaderBytes + sample_bytes * static_cast<std::uint64_t>(samples);
  if (bytes.size() != expected) {
    throw Error(fmt::format("{}: has {} bytes, expected {} for {} points and {} samples", file,
                            bytes.size(), expected, points, samples));
  }
  for (std::int32_t s = 0; s < samples; ++s) {
    Eigen::Matrix3Xf sample(3, points);
    std::memcpy(sample.data(),
                bytes.data() + kHeaderBytes + sample_bytes * static_cast<std::uint64_t>(s),
                sample_bytes);
    cache.samples.push_back(std::move(sample));
  }
  return cache;
}

}  // namespace weft::scenes
