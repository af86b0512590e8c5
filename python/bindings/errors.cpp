#include <weft/python/bindings/errors.hpp>

#include <exception>

#include <pybind11/pybind11.h>

#include <weft/core/error.hpp>

namespace weft::python {
namespace {

namespace py = pybind11;

void raise(const char* name, const char* message) {
  // A path in a message may be no UTF-8, which Python would refuse in place of raising the error.
  const auto text = py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(
      message, static_cast<py::ssize_t>(std::char_traits<char>::length(message)),
      "backslashreplace"));
  PyErr_SetObject(py::module_::import("weft.errors").attr(name).ptr(), text.ptr());
}

}  // namespace

void translate_errors() {
  py::register_local_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const InvalidArgument& invalid) {
      raise("InvalidArgument", invalid.what());
    } catch (const Error& other) {
      raise("Error", other.what());
    }
  });
}

}  // namespace weft::python
