/// Long calls from Python: other threads of Python run in the meantime, Ctrl-C ends the call, and it reports its
/// progress.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <memory>

#include "core/base/parallel.h"

namespace pcl_symmetry::python {

/// An exception of Python raised during a call. It is not a std::exception, because these are collected where one of
/// many models fails.
struct RaisedMeanwhile {
  std::shared_ptr<pybind11::error_already_set> error;
};

/// Receives the share done; null if there is no callback. The package sets it for the duration of a call.
inline thread_local PyObject* told_progress = nullptr;

/// Replaces pybind11::gil_scoped_release around long computations.
class Computing {
public:
  Computing() : monitor_(&report) {}

private:
  static void report(double share) {
    const pybind11::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() == 0) {
      if (!told_progress) return;
      if (PyObject* result = PyObject_CallFunction(told_progress, "d", share)) {
        Py_DECREF(result);
        return;
      }
    }
    throw RaisedMeanwhile{std::make_shared<pybind11::error_already_set>()};
  }

  pybind11::gil_scoped_release release_;
  ProgressMonitor monitor_;
};

/// Adds a function with these parameter names, all of which the package passes.
template <typename Function, typename... Names>
void add(pybind11::module_& module, const char* name, const Function& function, Names... parameters) {
  module.def(name, function, pybind11::arg(parameters)...);
}

/// Adds the functions that the package needs for this header to a module.
inline void addComputing(pybind11::module_& module) {
  module.def("tell",
             [](const pybind11::object& progress) { told_progress = progress.is_none() ? nullptr : progress.ptr(); });
  pybind11::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const RaisedMeanwhile& raised) {
      raised.error->restore();
    }
  });
}

}  // namespace pcl_symmetry::python
