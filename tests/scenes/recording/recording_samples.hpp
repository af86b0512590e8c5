#pragma once

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/scenes/recording/recording.hpp>

namespace weft::scenes::samples {

/// A folder that goes away at the end of a test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("weft_") + test->test_suite_name() + "_" + test->name() + "_" +
                       std::to_string(::getpid());
    std::replace(name.begin(), name.end(), '/', '_');  // in the names of parameterised tests
    path_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Two cloths and a moving ball.
inline Scene make_scene(int nodes = 5) {
  Scene scene;
  scene.name = "sample";
  scene.summary = "Shows a sample.";
  for (const char* name : {"towel", "flag"}) {
    Cloth cloth;
    cloth.name = name;
    cloth.grid().nodes = {nodes, nodes};
    scene.cloths.push_back(cloth);
  }
  Collider ball;
  ball.name = "ball";
  ball.shape = SphereShape{0.5};
  ball.mass = 2.0;
  scene.colliders.push_back(ball);
  return scene;
}

/// A smooth motion whose values fill the whole mantissa; rounded to float if asked, as a float
/// engine gives them.
inline SceneState make_state(const Scene& scene, int frame, StoredPrecision precision) {
  const auto rounded = [&](double value) {
    return precision == StoredPrecision::kFloat32 ? static_cast<double>(static_cast<float>(value))
                                                  : value;
  };
  SceneState state;
  state.time = frame / 60.0;
  for (const Cloth& cloth : scene.cloths) {
    const int nodes = cloth.grid().nodes[0] * cloth.grid().nodes[1];
    const double speed = cloth.name == "flag" ? 1.5 : 1.0;
    ClothState values{cloth.name, Matrix3X<double>(3, nodes), Matrix3X<double>(3, nodes)};
    for (int i = 0; i < 3 * nodes; ++i) {
      const double phase = 0.37 * i + speed * state.time;
      values.positions(i) = rounded(std::sin(phase));
      values.velocities(i) = rounded(std::cos(phase));
    }
    state.cloths.push_back(values);
  }
  for (const Collider& collider : scene.colliders) {
    RigidState rigid;
    rigid.name = collider.name;
    rigid.position = Vector3<double>(rounded(std::sin(state.time)), -0.0, 3.0);
    rigid.orientation.coeffs() << 0.0, rounded(std::sin(0.1 * frame)), 0.0,
        rounded(std::cos(0.1 * frame));
    rigid.velocity = Vector3<double>(rounded(std::cos(state.time)), 0.0, 0.5);
    rigid.angular_velocity = Vector3<double>(0.0, 0.25, rounded(1.0 / 3.0));
    state.rigids.push_back(rigid);
  }
  return state;
}

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

template <class A, class B>
bool same_bits(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  bool same = a.rows() == b.rows() && a.cols() == b.cols();
  for (Eigen::Index j = 0; same && j < a.cols(); ++j) {
    for (Eigen::Index i = 0; same && i < a.rows(); ++i) {
      same = same_bits(static_cast<double>(a(i, j)), static_cast<double>(b(i, j)));
    }
  }
  return same;
}

/// Every number of two states is the same, bit for bit, and so are the names.
inline bool same_bits(const SceneState& a, const SceneState& b) {
  bool same = same_bits(a.time, b.time) && a.cloths.size() == b.cloths.size() &&
              a.rigids.size() == b.rigids.size();
  for (std::size_t i = 0; same && i < a.cloths.size(); ++i) {
    same = a.cloths[i].name == b.cloths[i].name &&
           same_bits(a.cloths[i].positions, b.cloths[i].positions) &&
           same_bits(a.cloths[i].velocities, b.cloths[i].velocities);
  }
  for (std::size_t i = 0; same && i < a.rigids.size(); ++i) {
    const RigidState& p = a.rigids[i];
    const RigidState& q = b.rigids[i];
    same = p.name == q.name && same_bits(p.position, q.position) &&
           same_bits(p.orientation.coeffs(), q.orientation.coeffs()) &&
           same_bits(p.velocity, q.velocity) && same_bits(p.angular_velocity, q.angular_velocity);
  }
  return same;
}

inline const BlowUp kBlowUp{41, 0.41, "flag", 7, "position is not finite"};

/// Writes a recording with frames, metrics and a blow-up; returns its content hash.
inline std::string write_sample(const std::filesystem::path& path, const Scene& scene,
                                StoredPrecision precision, int num_frames,
                                const ChunkLimits& limits = {}, const Provenance& provenance = {}) {
  RecordingWriter writer(path, scene, provenance, precision, limits);
  for (int i = 0; i < num_frames; ++i) {
    const SceneState state = make_state(scene, i, precision);
    writer.add_frame(state);
    writer.add_metric("height_m", state.time, 0.1 * i);
  }
  writer.set_blow_up(kBlowUp);
  return writer.finish();
}

}  // namespace weft::scenes::samples
