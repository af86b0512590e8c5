#include <weft/playback/exchange/import/shape_sequence.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <span>
#include <system_error>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/core/input_file.hpp>
#include <weft/playback/exchange/import/obj_shape.hpp>
#include <weft/playback/exchange/point_cache.hpp>
#include <weft/scenes/recording/codec/stream_hash.hpp>

namespace weft::scenes {
namespace {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  try {
    return read_input_file(path);
  } catch (const InvalidArgument& error) {
    throw Error(path.string() + ": " + error.what());
  }
}

Matrix3X<double> to_world(Matrix3X<double> points, const FileAxes& axes) {
  if (axes.is_z_up) {
    const Eigen::RowVectorXd depth = -points.row(1);
    points.row(1) = points.row(2);
    points.row(2) = depth;
  }
  return axes.length_unit * points;
}

/// Refuses places that no node can be at; OBJ files are looked at by their reader.
void check_finite(const Matrix3X<double>& sample, std::size_t number, const std::string& file) {
  for (Eigen::Index i = 0; i < sample.cols(); ++i) {
    if (sample.col(i).allFinite()) continue;
    throw Error(
        fmt::format("{}: sample {}: position of point {} is not finite, expected finite ones", file,
                    number, i));
  }
}

/// A file of a sequence and the number of its frame.
struct NumberedFile {
  long long number = 0;
  fs::path path;
};

/// The last digits in a file's name.
long long frame_number(const fs::path& path) {
  const std::string stem = path.stem().string();
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  const auto last = std::find_if(stem.rbegin(), stem.rend(), is_digit);
  const auto first = std::find_if_not(last, stem.rend(), is_digit);
  const std::string digits(first.base(), last.base());
  long long number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (digits.empty() || error != std::errc()) {
    throw Error(path.string() +
                ": has no number of a frame in its name, expected one such as "
                "cloth_0001.obj");
  }
  return number;
}

bool fits(std::string_view name, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  const std::string_view before = pattern.substr(0, star);
  const std::string_view after = pattern.substr(star + 1);
  return name.size() >= before.size() + after.size() && name.starts_with(before) &&
         name.ends_with(after);
}

std::vector<NumberedFile> files_of_sequence(const fs::path& place) {
  const bool is_pattern = place.filename().string().find('*') != std::string::npos;
  const std::string pattern = is_pattern ? place.filename().string() : "*.obj";
  const fs::path folder = !is_pattern                   ? place
                          : place.parent_path().empty() ? fs::path(".")
                                                        : place.parent_path();
  std::error_code error;
  std::vector<NumberedFile> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path path =
        is_pattern ? place.parent_path() / entry->path().filename() : entry->path();
    if (fits(path.filename().string(), pattern)) files.push_back({frame_number(path), path});
  }
  if (error) {
    throw Error(
        fmt::format("{}: cannot be read as a folder: {}", folder.string(), error.message()));
  }
  if (files.size() < 2) {
    throw Error(fmt::format("{}: {} OBJ files, expected one for each frame and at least two",
                            place.string(), files.size()));
  }
  std::sort(files.begin(), files.end(), [](const NumberedFile& a, const NumberedFile& b) {
    return std::pair(a.number, a.path) < std::pair(b.number, b.path);
  });
  return files;
}

/// The frames from one file to the next, the same everywhere.
long long check_spacing(const std::vector<NumberedFile>& files) {
  const long long spacing = files[1].number - files[0].number;
  for (std::size_t i = 1; i < files.size(); ++i) {
    const NumberedFile& before = files[i - 1];
    const NumberedFile& file = files[i];
    if (file.number == before.number) {
      throw Error(
          fmt::format("{}: is frame {} as {} is, expected one file for a frame (a pattern "
                      "such as \"cloth_*.obj\" names one body)",
                      file.path.string(), file.number, before.path.string()));
    }
    if (file.number - before.number != spacing) {
      throw Error(
          fmt::format("{}: is frame {} and comes after frame {}, expected frame {}: a file "
                      "is missing",
                      file.path.string(), file.number, before.number, before.number + spacing));
    }
  }
  return spacing;
}

}  // namespace

ShapeSequence read_point_cache_sequence(const fs::path& path, const FileAxes& axes) {
  const std::string bytes = read_file(path);
  const PointCache cache = decode_point_cache(bytes, path.string());
  ShapeSequence sequence;
  sequence.source = path.string();
  sequence.precision = StoredPrecision::kFloat32;
  sequence.frames_per_sample = static_cast<double>(cache.frame_step);
  StreamHash hash;
  hash.add(std::as_bytes(std::span(bytes)));
  sequence.content_hash = hash.hex();
  for (const Eigen::Matrix3Xf& sample : cache.samples) {
    sequence.samples.push_back(to_world(sample.cast<double>(), axes));
    check_finite(sequence.samples.back(), sequence.samples.size() - 1, sequence.source);
  }
  const fs::path mesh = fs::path(path).replace_extension(".obj");
  std::error_code ignored;
  if (!fs::exists(mesh, ignored)) return sequence;
  ObjShape shape = read_obj_shape(read_file(mesh), mesh.string());
  if (shape.points.cols() != sequence.samples.front().cols()) {
    throw Error(fmt::format("{}: has {} points, expected {} as {} beside it has", path.string(),
                            sequence.samples.front().cols(), shape.points.cols(), mesh.string()));
  }
  sequence.faces = std::move(shape.faces);
  sequence.faces_source = mesh.string();
  return sequence;
}

ShapeSequence read_obj_sequence(const fs::path& place, const FileAxes& axes) {
  const std::vector<NumberedFile> files = files_of_sequence(place);
  ShapeSequence sequence;
  sequence.source = place.string();
  sequence.faces_source = files.front().path.string();
  sequence.frames_per_sample = static_cast<double>(check_spacing(files));
  StreamHash hash;
  for (const NumberedFile& file : files) {
    const std::string text = read_file(file.path);
    hash.add(std::as_bytes(std::span(text)));
    ObjShape shape = read_obj_shape(text, file.path.string());
    if (sequence.samples.empty()) sequence.faces = shape.faces;
    const Eigen::Index points =
        sequence.samples.empty() ? shape.points.cols() : sequence.samples.front().cols();
    if (shape.points.cols() != points || shape.faces != sequence.faces) {
      throw Error(
          fmt::format("{}: has {} points and {} faces, expected the {} points and the {} "
                      "faces of {}, in its order",
                      file.path.string(), shape.points.cols(), shape.faces.size(), points,
                      sequence.faces.size(), sequence.faces_source));
    }
    sequence.samples.push_back(to_world(std::move(shape.points), axes));
  }
  sequence.content_hash = hash.hex();
  return sequence;
}

}  // namespace weft::scenes
