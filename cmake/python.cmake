# Python and pybind11 for the module; without them it is left out. The system's Python, for which Debian's packages are made, unless a
# virtual environment is active or Python3_EXECUTABLE names another.
if(NOT Python3_EXECUTABLE AND NOT DEFINED ENV{VIRTUAL_ENV} AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python3 COMPONENTS Interpreter Development.Module QUIET)
find_package(pybind11 2.10 QUIET CONFIG)
if(NOT Python3_FOUND OR NOT pybind11_FOUND)
  message(STATUS "The Python module is left out: it needs python3-dev and pybind11-dev")
  set(PCL_SYMMETRY_BUILD_PYTHON OFF)
endif()
