#include <weft/scenes/recording/codec/frame_codec.hpp>

#include <bit>
#include <cstdint>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/scenes/recording/codec/little_endian.hpp>

namespace weft::scenes {
namespace {

/// Position and velocity of a node; pose (3 + 4) and velocities (3 + 3) of a rigid body.
constexpr std::size_t kNodeScalars = 6;
constexpr std::size_t kRigidScalars = 13;

template <class Scalar, class Bits>
class ScalarWriter {
 public:
  explicit ScalarWriter(std::byte* to) : to_(to) {}
  void put(const double* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i, to_ += sizeof(Bits)) {
      store_little_endian(std::bit_cast<Bits>(static_cast<Scalar>(values[i])), to_);
    }
  }

 private:
  std::byte* to_;
};

template <class Scalar, class Bits>
class ScalarReader {
 public:
  explicit ScalarReader(const std::byte* from) : from_(from) {}
  void get(double* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i, from_ += sizeof(Bits)) {
      values[i] = static_cast<double>(std::bit_cast<Scalar>(load_little_endian<Bits>(from_)));
    }
  }

 private:
  const std::byte* from_;
};

template <class Writer>
void write_state(const SceneState& state, Writer writer) {
  for (const ClothState& cloth : state.cloths) {
    writer.put(cloth.positions.data(), static_cast<std::size_t>(cloth.positions.size()));
    writer.put(cloth.velocities.data(), static_cast<std::size_t>(cloth.velocities.size()));
  }
  for (const RigidState& rigid : state.rigids) {
    writer.put(rigid.position.data(), 3);
    writer.put(rigid.orientation.coeffs().data(), 4);  // x, y, z, w
    writer.put(rigid.velocity.data(), 3);
    writer.put(rigid.angular_velocity.data(), 3);
  }
}

template <class Reader>
void read_state(const std::vector<RecordedBody>& bodies, Reader reader, SceneState& state) {
  for (const RecordedBody& body : bodies) {
    if (body.is_cloth) {
      ClothState cloth{body.name, Matrix3X<double>(3, body.num_nodes),
                       Matrix3X<double>(3, body.num_nodes)};
      reader.get(cloth.positions.data(), static_cast<std::size_t>(cloth.positions.size()));
      reader.get(cloth.velocities.data(), static_cast<std::size_t>(cloth.velocities.size()));
      state.cloths.push_back(std::move(cloth));
    } else {
      RigidState rigid;
      rigid.name = body.name;
      reader.get(rigid.position.data(), 3);
      reader.get(rigid.orientation.coeffs().data(), 4);
      reader.get(rigid.velocity.data(), 3);
      reader.get(rigid.angular_velocity.data(), 3);
      state.rigids.push_back(std::move(rigid));
    }
  }
}

void check_cloth(const ClothState& cloth, const RecordedBody& body) {
  if (cloth.name != body.name) {
    throw InvalidArgument(
        fmt::format("add_frame: cloth '{}', expected '{}'", cloth.name, body.name));
  }
  for (const auto* values : {&cloth.positions, &cloth.velocities}) {
    if (values->cols() != body.num_nodes) {
      throw InvalidArgument(fmt::format("add_frame: cloth '{}' has {} nodes, expected {}",
                                        cloth.name, values->cols(), body.num_nodes));
    }
  }
}

}  // namespace

std::vector<RecordedBody> recorded_bodies(const Scene& scene) {
  std::vector<RecordedBody> bodies;
  for (const Cloth& cloth : scene.cloths) {
    bodies.push_back({cloth.name, true, num_nodes(cloth.source)});
  }
  for (const Collider& collider : scene.colliders) {
    bodies.push_back({collider.name, false, 1});
  }
  return bodies;
}

FrameCodec::FrameCodec(std::vector<RecordedBody> bodies, StoredPrecision precision)
    : bodies_(std::move(bodies)), precision_(precision) {
  for (const RecordedBody& body : bodies_) frame_bytes_ += bytes_of(body);
}

std::size_t FrameCodec::bytes_of(const RecordedBody& body) const {
  const auto nodes = static_cast<std::size_t>(body.num_nodes);
  return (body.is_cloth ? kNodeScalars * nodes : kRigidScalars) * scalar_bytes();
}

void FrameCodec::set_num_nodes(std::size_t body, int num_nodes) {
  frame_bytes_ -= bytes_of(bodies_[body]);
  bodies_[body].num_nodes = num_nodes;
  frame_bytes_ += bytes_of(bodies_[body]);
}

std::size_t FrameCodec::scalar_bytes() const {
  return precision_ == StoredPrecision::kFloat64 ? sizeof(double) : sizeof(float);
}

void FrameCodec::check(const SceneState& state) const {
  const std::size_t num_bodies = state.cloths.size() + state.rigids.size();
  std::size_t num_cloths = 0;
  for (const RecordedBody& body : bodies_) {
    num_cloths += body.is_cloth ? 1 : 0;
  }
  if (state.cloths.size() != num_cloths || num_bodies != bodies_.size()) {
    throw InvalidArgument(fmt::format(
        "add_frame: {} cloths and {} rigid bodies, expected {} and {}", state.cloths.size(),
        state.rigids.size(), num_cloths, bodies_.size() - num_cloths));
  }
  for (std::size_t i = 0; i < num_cloths; ++i) {
    check_cloth(state.cloths[i], bodies_[i]);
  }
  for (std::size_t i = 0; i < state.rigids.size(); ++i) {
    const std::string& expected = bodies_[num_cloths + i].name;
    if (state.rigids[i].name != expected) {
      throw InvalidArgument(
          fmt::format("add_frame: rigid body '{}', expected '{}'", state.rigids[i].name, expected));
    }
  }
}

void FrameCodec::encode(const SceneState& state, std::vector<std::byte>& out) const {
  const std::size_t begin = out.size();
  out.resize(begin + frame_bytes_);
  if (precision_ == StoredPrecision::kFloat64) {
    write_state(state, ScalarWriter<double, std::uint64_t>(out.data() + begin));
  } else {
    write_state(state, ScalarWriter<float, std::uint32_t>(out.data() + begin));
  }
}

SceneState FrameCodec::decode(std::span<const std::byte> bytes) const {
  SceneState state;
  if (precision_ == StoredPrecision::kFloat64) {
    read_state(bodies_, ScalarReader<double, std::uint64_t>(bytes.data()), state);
  } else {
    read_state(bodies_, ScalarReader<float, std::uint32_t>(bytes.data()), state);
  }
  return state;
}

}  // namespace weft::scenes
