#include <weft/scenes/recording/verify.hpp>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

/// The first column with a value that is not finite.
std::optional<int> non_finite_column(const Matrix3X<double>& values) {
  for (Eigen::Index i = 0; i < values.cols(); ++i) {
    if (!values.col(i).allFinite()) return static_cast<int>(i);
  }
  return std::nullopt;
}

std::optional<NonFiniteValue> non_finite_value(const SceneState& state, int frame) {
  for (const ClothState& cloth : state.cloths) {
    if (const auto node = non_finite_column(cloth.positions)) {
      return NonFiniteValue{frame, state.time, cloth.name, node, "position"};
    }
    if (const auto node = non_finite_column(cloth.velocities)) {
      return NonFiniteValue{frame, state.time, cloth.name, node, "velocity"};
    }
  }
  for (const RigidState& rigid : state.rigids) {
    const char* quantity = !rigid.position.allFinite()               ? "position"
                           : !rigid.orientation.coeffs().allFinite() ? "orientation"
                           : !rigid.velocity.allFinite()             ? "velocity"
                           : !rigid.angular_velocity.allFinite()     ? "angular velocity"
                                                                     : nullptr;
    if (quantity) return NonFiniteValue{frame, state.time, rigid.name, {}, quantity};
  }
  return std::nullopt;
}

class Verifier {
 public:
  explicit Verifier(const RecordingReader& reader) : reader_(reader) {}

  Verification run(const std::function<void(double)>& progress) {
    result_.num_frames = reader_.num_frames();
    attempt([&] { (void)reader_.scene(); });
    for (int frame = 0; frame < result_.num_frames; ++frame) {
      attempt([&] { look_at(frame); });
      if (progress) progress((frame + 1.0) / result_.num_frames);
    }
    attempt([&] { (void)reader_.metric_names(); });
    attempt([&] { (void)reader_.notes(); });
    // With a frame that cannot be read it would only be the same fault again.
    if (result_.num_readable == result_.num_frames) attempt([&] { (void)reader_.content_hash(); });
    return result_;
  }

 private:
  template <class Read>
  void attempt(const Read& read) {
    try {
      read();
    } catch (const Error& error) {
      // Each frame of a damaged chunk has the same fault.
      const std::string fault = error.what();
      if (result_.faults.empty() || result_.faults.back() != fault) result_.faults.push_back(fault);
    }
  }

  void look_at(int frame) {
    const SceneState state = reader_.frame(frame);
    attempt([&] { (void)reader_.marks(frame); });
    ++result_.num_readable;
    if (result_.readable.empty() || result_.readable.back().last != frame - 1) {
      result_.readable.push_back({frame, frame});
    }
    result_.readable.back().last = frame;
    const std::optional<NonFiniteValue> value = non_finite_value(state, frame);
    if (!value) return;
    ++result_.num_non_finite;
    if (!result_.first_non_finite) result_.first_non_finite = value;
  }

  const RecordingReader& reader_;
  Verification result_;
};

}  // namespace

Verification verify_recording(const RecordingReader& reader,
                              const std::function<void(double)>& progress) {
  return Verifier(reader).run(progress);
}

}  // namespace weft::scenes
