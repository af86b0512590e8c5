#pragma once

// Tested by tests/playback/exchange/vtp_export_test.cpp, tests/playback/exchange/vtk_reads_export.py.

#include <string>
#include <vector>

#include <weft/core/types.hpp>

namespace weft::scenes {

/// One number or vector for each point.
struct VtpField {
  std::string name;        ///< with its unit, as "velocity_m_s"
  Eigen::MatrixXd values;  ///< components x n
};

/// Points, triangles and lines with fields, as VTK's PolyData.
struct VtpSurface {
  Matrix3X<double> points;  ///< 3 x n [m]
  Triangles triangles;
  Edges lines = Edges(2, 0);
  std::vector<VtpField> fields;
};

/// Text of a VTP file with inline base64 data. is_double: 64-bit numbers, else 32-bit.
[[nodiscard]] std::string vtp_text(const VtpSurface& surface, bool is_double);

}  // namespace weft::scenes
