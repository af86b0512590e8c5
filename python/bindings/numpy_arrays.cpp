#include <weft/python/bindings/numpy_arrays.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <weft/core/error.hpp>

namespace weft::python {
namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Integers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

std::string shape_text(const py::array& array) {
  const std::vector<py::ssize_t> shape(array.shape(), array.shape() + array.ndim());
  return fmt::format("({}{})", fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
}

/// The object as an array whose elements are of one of these kinds (NumPy's letters), in whatever shape.
py::array array_from(const py::handle& object, const std::string& kinds, const std::string& where,
                     const std::string& expected) {
  const py::array array = py::array::ensure(object);
  if (!array) PyErr_Clear();
  // An empty list is an array of doubles to NumPy.
  const bool is_empty = array && array.size() == 0;
  if (!array || (!is_empty && kinds.find(array.dtype().kind()) == std::string::npos)) {
    throw InvalidArgument(fmt::format(
        "{} is no array of {}, but {}", where, expected,
        array ? std::string(py::str(array.dtype())) : std::string(Py_TYPE(object.ptr())->tp_name)));
  }
  return array;
}

void require_shape(bool is_right, const py::array& array, const std::string& where,
                   const std::string& expected) {
  if (is_right) return;
  throw InvalidArgument(
      fmt::format("{} has the shape {}, expected {}", where, shape_text(array), expected));
}

Doubles finite_numbers(const py::handle& object, const std::string& where,
                       const std::string& unit) {
  auto array = Doubles::ensure(array_from(object, "fiu", where, "numbers"));
  const double* const values = array.data();
  const double* const end = values + array.size();
  const double* const bad =
      std::find_if_not(values, end, [](double v) { return std::isfinite(v); });
  if (bad != end) {
    throw InvalidArgument(fmt::format("{}: number {} = {} [{}], expected a finite one", where,
                                      bad - values, *bad, unit));
  }
  return array;
}

int node_at(const Integers& array, py::ssize_t i, int num_nodes, const std::string& where) {
  const std::int64_t node = array.at(i) < 0 ? array.at(i) + num_nodes : array.at(i);
  if (node < 0 || node >= num_nodes) {
    throw InvalidArgument(fmt::format("{}[{}] = {}, expected a node from {} to {}", where, i,
                                      array.at(i), -num_nodes, num_nodes - 1));
  }
  return static_cast<int>(node);
}

}  // namespace

Matrix3X<double> points_from(const py::handle& object, const std::string& where,
                             const std::string& unit) {
  const Doubles array = finite_numbers(object, where, unit);
  require_shape(array.ndim() == 2 && array.shape(1) == 3, array, where, "(n, 3)");
  return Eigen::Map<const Matrix3X<double>>(array.data(), 3, array.shape(0));
}

Matrix3X<double> points_from(const py::handle& object, Eigen::Index num_rows,
                             const std::string& where, const std::string& unit) {
  Matrix3X<double> points = points_from(object, where, unit);
  if (points.cols() != num_rows) {
    throw InvalidArgument(
        fmt::format("{} has the shape ({}, 3), expected ({}, 3)", where, points.cols(), num_rows));
  }
  return points;
}

Vector3<double> vector_from(const py::handle& object, const std::string& where,
                            const std::string& unit) {
  const Doubles array = finite_numbers(object, where, unit);
  require_shape(array.ndim() == 1 && array.shape(0) == 3, array, where, "(3,)");
  return {array.at(0), array.at(1), array.at(2)};
}

std::vector<double> numbers_from(const py::handle& object, const std::string& where,
                                 const std::string& unit) {
  const Doubles array = finite_numbers(object, where, unit);
  require_shape(array.ndim() <= 1, array, where, "a number or (n,)");
  return {array.data(), array.data() + array.size()};
}

Triangles triangles_from(const py::handle& object, Eigen::Index num_nodes,
                         const std::string& where) {
  const py::array given = array_from(object, "iu", where, "whole numbers");
  require_shape(given.ndim() == 2 && given.shape(1) == 3, given, where, "(t, 3)");
  const auto array = Integers::ensure(given);
  Triangles triangles(3, array.shape(0));
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (Eigen::Index corner = 0; corner < 3; ++corner) {
      const std::int64_t node = array.at(t, corner);
      if (node < 0 || node >= num_nodes) {
        throw InvalidArgument(fmt::format("{}[{}, {}] = {}, expected a node from 0 to {}", where, t,
                                          corner, node, num_nodes - 1));
      }
      triangles(corner, t) = static_cast<int>(node);
    }
  }
  return triangles;
}

std::vector<int> sorted_nodes_from(const py::handle& object, int num_nodes,
                                   const std::string& where) {
  const py::array given = array_from(object, "iu", where, "whole numbers");
  require_shape(given.ndim() == 1, given, where, "(n,)");
  const auto array = Integers::ensure(given);
  std::vector<int> nodes;
  for (py::ssize_t i = 0; i < array.size(); ++i)
    nodes.push_back(node_at(array, i, num_nodes, where));
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::vector<int> nodes_from(const py::handle& object, int num_nodes, const std::string& where) {
  const py::array given = array_from(object, "iu", where, "whole numbers");
  require_shape(given.ndim() == 1, given, where, "(n,)");
  const auto array = Integers::ensure(given);
  std::vector<int> nodes;
  std::vector<bool> is_named(static_cast<std::size_t>(num_nodes), false);
  for (py::ssize_t i = 0; i < array.size(); ++i) {
    nodes.push_back(node_at(array, i, num_nodes, where));
    auto named = is_named[static_cast<std::size_t>(nodes.back())];
    if (named) {
      throw InvalidArgument(
          fmt::format("{}: node {} is named twice, expected each once", where, nodes.back()));
    }
    named = true;
  }
  return nodes;
}

py::array_t<double> rows_of(const Matrix3X<double>& columns) {
  py::array_t<double> rows({columns.cols(), Eigen::Index{3}});
  std::copy(columns.data(), columns.data() + columns.size(), rows.mutable_data());
  return rows;
}

py::array_t<double> array_of(const VectorX<double>& numbers) {
  return py::array_t<double>(numbers.size(), numbers.data());
}

py::tuple tuple_of(const Vector3<double>& vector) {
  return py::make_tuple(vector[0], vector[1], vector[2]);
}

}  // namespace weft::python
