#pragma once

// Tested by tests/python/test_mesh.py.

#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <weft/core/types.hpp>

namespace weft::python {

namespace py = pybind11;

/// What Python gives, as Weft's matrices. Each throws InvalidArgument that begins with where and names the value for what is no
/// array of numbers, has another shape, or has numbers out of range.

/// n rows of three finite numbers, as 3 x n; unit is for the message.
[[nodiscard]] Matrix3X<double> points_from(const py::handle& object, const std::string& where,
                                           const std::string& unit);
/// The same with exactly so many rows.
[[nodiscard]] Matrix3X<double> points_from(const py::handle& object, Eigen::Index num_rows,
                                           const std::string& where, const std::string& unit);
/// Three finite numbers.
[[nodiscard]] Vector3<double> vector_from(const py::handle& object, const std::string& where,
                                          const std::string& unit);
/// Numbers, each finite, as many as there are.
[[nodiscard]] std::vector<double> numbers_from(const py::handle& object, const std::string& where,
                                               const std::string& unit);
/// t rows of three whole numbers from 0 to num_nodes - 1, as 3 x t.
[[nodiscard]] Triangles triangles_from(const py::handle& object, Eigen::Index num_nodes,
                                       const std::string& where);
/// Whole numbers from 0 to num_nodes - 1, each once, in the order given; negative ones count from the end, as in NumPy.
[[nodiscard]] std::vector<int> nodes_from(const py::handle& object, int num_nodes,
                                          const std::string& where);

/// The same in ascending order, each once however often it is named.
[[nodiscard]] std::vector<int> sorted_nodes_from(const py::handle& object, int num_nodes,
                                                 const std::string& where);

/// A copy with a row for each column.
[[nodiscard]] py::array_t<double> rows_of(const Matrix3X<double>& columns);
template <int kRows>
[[nodiscard]] py::array_t<int> rows_of(const Eigen::Matrix<int, kRows, Eigen::Dynamic>& columns) {
  py::array_t<int> rows({columns.cols(), columns.rows()});
  std::copy(columns.data(), columns.data() + columns.size(), rows.mutable_data());
  return rows;
}
[[nodiscard]] py::array_t<double> array_of(const VectorX<double>& numbers);
[[nodiscard]] py::tuple tuple_of(const Vector3<double>& vector);

}  // namespace weft::python
