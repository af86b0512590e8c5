#include <weft/scenes/import/assimp_file.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include <assimp/BaseImporter.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>

#include <weft/core/error.hpp>
#include <weft/scenes/import/input_system.hpp>

namespace weft::import {
namespace {

constexpr std::size_t kMaxCorners = 10'000'000;
constexpr int kMaxDepth = 1000;  // of nodes within nodes: deeper is a circle

void require(bool ok, const std::string& message) {
  if (!ok) throw Error(message);
}

/// Keeps assimp's word on what it has left out without an error.
class LossLog final : public Assimp::LogStream {
 public:
  explicit LossLog(std::string& loss) : loss_(loss) {}
  void write(const char* message) override {
    const std::string text = message;
    const bool is_loss = text.find("dropped") != std::string::npos ||
                         text.find("out-of-range") != std::string::npos ||
                         text.find("out of range") != std::string::npos;
    // Without assimp's "Warn, T0: ".
    const std::size_t colon = text.find(": ");
    if (is_loss && loss_.empty()) loss_ = text.substr(colon == std::string::npos ? 0 : colon + 2);
  }

 private:
  std::string& loss_;
};

/// While it lives, assimp's warnings go to the log.
class LogGuard {
 public:
  explicit LogGuard(std::string& loss) : log_(loss) {
    Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(&log_, Assimp::Logger::Warn | Assimp::Logger::Err);
  }
  ~LogGuard() {
    Assimp::DefaultLogger::get()->detachStream(&log_, Assimp::Logger::Warn | Assimp::Logger::Err);
    Assimp::DefaultLogger::kill();
  }
  LogGuard(const LogGuard&) = delete;
  LogGuard& operator=(const LogGuard&) = delete;

 private:
  LossLog log_;
};

/// assimp looks into a file and may take another reader than the one of its extension. Those of the
/// other forty formats are not tested here, and some open further files.
void keep_tested_readers(Assimp::Importer& importer) {
  constexpr std::array<std::string_view, 5> kKept = {"obj", "glb", "ply", "fbx", "stl"};
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const aiImporterDesc& description = *importer.GetImporterInfo(i);
    const std::string extensions = " " + std::string(description.mFileExtensions) + " ";
    const bool is_kept = std::any_of(kKept.begin(), kKept.end(), [&](std::string_view one) {
      return extensions.find(" " + std::string(one) + " ") != std::string::npos;
    });
    // Two readers take the extensions of glTF; this one is for version 1.
    const bool is_old = std::string_view(description.mName) == "glTF Importer";
    if (is_kept && !is_old) continue;
    const std::unique_ptr<Assimp::BaseImporter> owned(importer.GetImporter(i));
    (void)importer.UnregisterLoader(owned.get());
  }
}

class PartCollector {
 public:
  explicit PartCollector(const aiScene& scene) : scene_(scene) {}

  void add(const aiNode& node, const aiMatrix4x4& parent, int depth) {
    require(depth < kMaxDepth, "nodes are nested more than " + std::to_string(kMaxDepth) +
                                   " deep, expected no circle");
    const aiMatrix4x4 place = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      require(node.mMeshes[i] < scene_.mNumMeshes,
              "node '" + std::string(node.mName.C_Str()) + "' names mesh " +
                  std::to_string(node.mMeshes[i]) + ", which is not there");
      add(node, *scene_.mMeshes[node.mMeshes[i]], place);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], place, depth + 1);
  }
  [[nodiscard]] std::vector<FilePart>& parts() { return parts_; }

 private:
  void add(const aiNode& node, const aiMesh& mesh, const aiMatrix4x4& place) {
    num_corners_ += mesh.mNumVertices;
    require(num_corners_ <= kMaxCorners,
            "more than " + std::to_string(kMaxCorners) + " vertices, expected fewer");
    FilePart part;
    part.node = node.mName.C_Str();
    part.mesh = mesh.mName.C_Str();
    if (mesh.mMaterialIndex < scene_.mNumMaterials) {
      part.material = scene_.mMaterials[mesh.mMaterialIndex]->GetName().C_Str();
    }
    const bool has_texture = mesh.HasTextureCoords(0);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D position = place * mesh.mVertices[v];
      for (const ai_real x : {position.x, position.y, position.z}) part.positions.push_back(x);
      if (!has_texture) continue;
      part.texture_coordinates.push_back(mesh.mTextureCoords[0][v].x);
      part.texture_coordinates.push_back(mesh.mTextureCoords[0][v].y);
    }
    add_faces(mesh, place.Determinant() < 0, part);
    add_groups(mesh, part);
    parts_.push_back(std::move(part));
  }

  void add_faces(const aiMesh& mesh, bool is_mirrored, FilePart& part) {
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      num_corners_ += face.mNumIndices;
      require(num_corners_ <= kMaxCorners,
              "more than " + std::to_string(kMaxCorners) + " corners, expected fewer");
      std::vector<int> corners;
      for (unsigned c = 0; c < face.mNumIndices; ++c) {
        require(face.mIndices[c] < mesh.mNumVertices,
                "face " + std::to_string(f) + " of '" + part.mesh + "' names vertex " +
                    std::to_string(face.mIndices[c]) + ", expected 0 to " +
                    std::to_string(mesh.mNumVertices) + " - 1");
        corners.push_back(static_cast<int>(face.mIndices[c]));
      }
      // A mirror turns the front to the back.
      if (is_mirrored) corners = {corners.rbegin(), corners.rend()};
      part.faces.push_back(std::move(corners));
    }
  }

  static void add_groups(const aiMesh& mesh, FilePart& part) {
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      FileGroup group{bone.mName.C_Str(), {}};
      for (unsigned w = 0; w < bone.mNumWeights; ++w) {
        const aiVertexWeight& weight = bone.mWeights[w];
        require(weight.mVertexId < mesh.mNumVertices,
                "bone '" + group.name + "' names a vertex that is not there");
        group.weights.emplace_back(static_cast<int>(weight.mVertexId), weight.mWeight);
      }
      part.groups.push_back(std::move(group));
    }
  }

  const aiScene& scene_;
  std::vector<FilePart> parts_;
  std::size_t num_corners_ = 0;
};

}  // namespace

AssimpFile::AssimpFile(const MeshInput& input) : importer_(std::make_unique<Assimp::Importer>()) {
  keep_tested_readers(*importer_);
  auto* const system = new InputSystem(input);
  importer_->SetIOHandler(system);  // which owns it from now on
  std::string loss;
  {
    const LogGuard guard(loss);
    scene_ = importer_->ReadFile(system->mesh_name(), 0);
  }
  if (scene_ == nullptr) {
    throw Error(system->refusal().empty() ? importer_->GetErrorString() : system->refusal());
  }
  require(loss.empty(), loss);
  require(scene_->mRootNode != nullptr, "holds no scene");
}

AssimpFile::~AssimpFile() = default;

AssimpFile load_assimp(const MeshInput& input) {
  return AssimpFile(input);
}

std::vector<FilePart> parts_of(const aiScene& scene) {
  PartCollector collector(scene);
  collector.add(*scene.mRootNode, aiMatrix4x4(), 0);
  return std::move(collector.parts());
}

}  // namespace weft::import
