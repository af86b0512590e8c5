#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <weft/bridge/bullet/precision.hpp>

class btCollisionObject;
class btSoftBody;
class btVector3;

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {

/// In which precision the frames are stored.
enum class Precision {
  kOfBullet,  ///< that of the program's Bullet: nothing is lost
  kSingle,    ///< half the size for a Bullet in double precision, rounded to 24 bits
};

/// From where `weft render` and the playback page look at first.
struct View {
  std::array<double, 3> position{8, 6, 10};  ///< [m]
  std::array<double, 3> target{0, 1, 0};     ///< [m] another point than position
};

/// Whether a soft body keeps its nodes.
enum class Wholeness {
  kStaysWhole,  ///< as many nodes and faces as when it is added, in their order
  kMayTear,  ///< it may get nodes, to which faces are led, as by bridge::tear() and bridge::cut()
};

/// Where the frames go.
enum class BackEnd {
  kFile,
  kWindow,  ///< `weft view` follows them; they are kept until it is closed, which ~Recorder() waits for
  kBoth,  ///< a file, and a window that stays when the program has ended
  kNone,  ///< nowhere: every call returns at once, so that the calls may stay in the program
};

struct RecorderOptions {
  std::string name = "recording";      ///< of the scene: lower-case letters, digits and '_'
  std::string summary = {};            ///< one sentence for titles
  double frame_interval = 1.0 / 60.0;  ///< [s] between two frames, > 0
  Precision precision = Precision::kOfBullet;
  /// [m/s^2], for the energies that the playback page shows. None: the soft bodies' m_worldInfo,
  /// which is zero in a program whose gravity is a law of Weft.
  std::optional<std::array<double, 3>> gravity = std::nullopt;
  std::optional<View> view =
      std::nullopt;          ///< none: the bodies of the first frame fill the picture
  bool may_replace = false;  ///< a recording of this name may be replaced when this one is whole
  BackEnd back_end = BackEnd::kFile;
  std::string window_program = "weft";  ///< Weft's command, a path or a name in PATH
};

/// Records the bodies of a program's own Bullet world into a file that `weft render`, `weft info`
/// and `weft export --html` open. The world may have any soft-body solver, Weft's or Bullet's.
///
/// Bodies are only read. Each must live until the last record(). One thread at a time.
class Recorder {
 public:
  /// The frames go to "x.partial.weftrec" beside path until the recording is whole; path means nothing without a file.
  /// Throws InvalidArgument for options out of their domain and for a path that is taken by something else
  /// than a recording that may be replaced, and Error if another program records to it.
  explicit Recorder(const std::filesystem::path& path, const RecorderOptions& options = {});
  /// As finish(), but without a message: call finish() to learn of a full disk. While an exception
  /// leaves the recorder's scope, the partial recording stays and says that it is unfinished. A
  /// recording without a frame leaves nothing.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// A soft body with its nodes and faces. The positions that it has now are its rest shape, which
  /// strains refer to. Throws InvalidArgument, which names the body, after the first frame, for a
  /// name that is taken or has other characters than letters, digits, '_' and '-', and for a body
  /// whose faces make no surface: each node belongs to a face, each face has an area, and no edge
  /// belongs to three of them.
  void add(const btSoftBody& body, const std::string& name,
           Wholeness wholeness = Wholeness::kStaysWhole);
  /// A rigid body or any other collision object, with a shape that is a sphere, box, capsule,
  /// cylinder, cone, convex hull of 4 to 128 points, static plane, or a compound of these without
  /// planes. Its shape now is the one that is drawn; a convex hull is drawn without its margin.
  /// Throws InvalidArgument as above, and for another shape.
  void add(const btCollisionObject& body, const std::string& name);

  /// To be called after each step, with the program's own time [s]. Takes a frame at the first call
  /// and then whenever another frame interval has passed; returns whether it did. Throws
  /// InvalidArgument for a time that is not finite or before that of the last call, for a recorder
  /// without a soft body, and for a body whose nodes or faces have changed in another way than it
  /// was added for; Error if the frame cannot be stored. Positions and velocities may be anything,
  /// also not finite, but in the first frame those of rigid bodies are finite.
  bool record(double time);

  /// record() in two parts, with what is drawn beside the bodies between them. begin_frame() returns whether a frame is due:
  /// if not, marks are not kept, and need not be computed. The bodies are read by end_frame(), which returns whether it took
  /// a frame. Throw as record(), and InvalidArgument for a frame in a frame, and for an end without a beginning.
  bool begin_frame(double time);
  bool end_frame();
  /// Points, lines from begins to ends, and arrows from origins along vectors, all in [m] of the world; what is called alike
  /// has one color. Kept are single precision. Throw InvalidArgument outside of a frame, without a name, and for other numbers
  /// of ends than of beginnings.
  void log_points(const std::string& name, std::span<const btVector3> points);
  void log_lines(const std::string& name, std::span<const btVector3> begins,
                 std::span<const btVector3> ends);
  void log_arrows(const std::string& name, std::span<const btVector3> origins,
                  std::span<const btVector3> vectors);
  /// What has happened, such as "the gripper lets go", at the time of the frame that has begun, or of the last one. Throws as
  /// metric().
  void event(const std::string& text);

  /// Says that a soft body has blown up in the step before the next record(), which then takes a
  /// frame in any case. Made for SoftBodySolver::set_on_blow_up(): the first recorded body counts,
  /// everything else is ignored. node is counted from 0.
  void blow_up(const btSoftBody& body, int node, const std::string& reason);
  /// A number at the time of the frame that has begun, or of the last record(), such as ("kinetic_energy_J", 1.25): its name ends
  /// with its unit, and the playback page draws those in J. The value may be NaN. Throws
  /// InvalidArgument before the first frame, after the end, and for an empty name.
  void metric(const std::string& name, double value);

  /// Gives the recording its name and returns its content hash. No frame may follow. Throws Error
  /// for a recording without a frame, and one that says where the frames are if it cannot be
  /// completed.
  std::string finish();

  [[nodiscard]] int num_frames() const;  ///< taken

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
