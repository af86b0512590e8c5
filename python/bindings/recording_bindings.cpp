// Tested by tests/python/test_recording.py.

#include <memory>

#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <weft/core/error.hpp>
#include <weft/python/bindings/core_module.hpp>
#include <weft/python/bindings/numpy_arrays.hpp>
#include <weft/python/bindings/scene_run.hpp>
#include <weft/scenes/recording/recording.hpp>

namespace weft::python {
namespace {

using scenes::RecordingReader;
using scenes::SceneState;

/// A matrix as rows of the precision that the recording has: no number changes, for it was stored so.
py::array stored_rows(const Matrix3X<double>& columns, scenes::StoredPrecision precision) {
  if (precision == scenes::StoredPrecision::kFloat64) return rows_of(columns);
  py::array_t<float> rows({columns.cols(), Eigen::Index{3}});
  std::transform(columns.data(), columns.data() + columns.size(), rows.mutable_data(),
                 [](double value) { return static_cast<float>(value); });
  return rows;
}

int checked_frame(const RecordingReader& reader, int frame) {
  const int last = reader.num_frames() - 1;
  const int from_start = frame < 0 ? frame + reader.num_frames() : frame;
  if (from_start < 0 || from_start > last) {
    // The type that ends a loop over the frames.
    throw py::index_error(
        fmt::format("recording: frame {}, expected one from 0 to {}", frame, last));
  }
  return from_start;
}

py::dict cloth_dict(const scenes::ClothState& cloth, scenes::StoredPrecision precision) {
  py::dict result;
  result["positions"] = stored_rows(cloth.positions, precision);
  result["velocities"] = stored_rows(cloth.velocities, precision);
  result["triangles"] =
      cloth.topology ? py::object(rows_of(cloth.topology->triangles)) : py::object(py::none());
  return result;
}

py::dict rigid_dict(const scenes::RigidState& rigid) {
  const Eigen::Quaterniond& q = rigid.orientation;
  py::dict result;
  result["position"] = tuple_of(rigid.position);
  result["orientation"] = py::make_tuple(q.x(), q.y(), q.z(), q.w());
  result["velocity"] = tuple_of(rigid.velocity);
  result["angular_velocity"] = tuple_of(rigid.angular_velocity);
  return result;
}

py::dict frame_dict(const RecordingReader& reader, int frame) {
  const SceneState state = reader.frame(checked_frame(reader, frame));
  py::dict cloths;
  for (const auto& cloth : state.cloths) {
    cloths[py::str(cloth.name)] = cloth_dict(cloth, reader.precision());
  }
  py::dict rigids;
  for (const auto& rigid : state.rigids) rigids[py::str(rigid.name)] = rigid_dict(rigid);
  py::dict result;
  result["time"] = state.time;
  result["cloths"] = cloths;
  result["bodies"] = rigids;
  return result;
}

py::array_t<double> times_of(const RecordingReader& reader) {
  py::array_t<double> times(reader.num_frames());
  for (int frame = 0; frame < reader.num_frames(); ++frame) {
    times.mutable_at(frame) = reader.frame_time(frame);
  }
  return times;
}

py::tuple metric_of(const RecordingReader& reader, const std::string& name) {
  const std::vector<std::string> names = reader.metric_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw InvalidArgument(fmt::format("recording: metric '{}' is not in it, expected {}", name,
                                      names.empty()
                                          ? std::string("none, for it has none")
                                          : fmt::format("one of {}", fmt::join(names, ", "))));
  }
  const auto samples = reader.metric(name);
  py::array_t<double> times(static_cast<py::ssize_t>(samples.size()));
  py::array_t<double> values(static_cast<py::ssize_t>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    times.mutable_at(i) = samples[i].time;
    values.mutable_at(i) = samples[i].value;
  }
  return py::make_tuple(times, values);
}

}  // namespace

void bind_recordings(py::module_& module) {
  py::class_<RecordingReader>(module, "RecordingReader")
      .def(py::init([](const std::filesystem::path& path) {
             return std::make_unique<RecordingReader>(path);
           }),
           py::arg("path"))
      .def("__len__", &RecordingReader::num_frames)
      .def("frame", &frame_dict, py::arg("frame"))
      .def("times", &times_of)
      .def_property_readonly("scene", [](const RecordingReader& r) { return r.scene(); })
      .def_property_readonly("scene_text", &RecordingReader::scene_text)
      .def_property_readonly("provenance", &RecordingReader::provenance)
      .def_property_readonly(
          "precision",
          [](const RecordingReader& r) {
            return r.precision() == scenes::StoredPrecision::kFloat64 ? "float64" : "float32";
          })
      .def_property_readonly("finished", &RecordingReader::finished)
      .def_property_readonly("content_hash", &RecordingReader::content_hash)
      .def_property_readonly("blow_up",
                             [](const RecordingReader& r) { return blow_up_dict(r.blow_up()); })
      .def_property_readonly("metric_names", &RecordingReader::metric_names)
      .def("metric", &metric_of, py::arg("name"))
      .def("first_mesh", [](const RecordingReader& r, const std::string& cloth) {
        for (const scenes::Cloth& one : r.scene().cloths) {
          if (one.name == cloth) return scenes::make_mesh(one);
        }
        throw InvalidArgument("recording: cloth '" + cloth +
                              "' is not in it, expected one of its scene");
      });
}

}  // namespace weft::python
