# What the libraries link. The tools find what they need besides in apps/CMakeLists.txt.
find_package(Eigen3 3.3 REQUIRED NO_MODULE)
find_package(Boost REQUIRED)  # headers: Boost.Graph
find_package(Threads REQUIRED)

# PCL 1.13 exports no imported targets, so its variables are wrapped in a function here. flann.pc drags in MPI and HDF5,
# so FLANN comes from the target that PCL's finder defines or, without PCL, from FLANN's own configuration.
if(PCL_SYMMETRY_BUILD_PCL)
  set(pcl_components common search kdtree registration segmentation)
  if(PCL_SYMMETRY_BUILD_APPS OR PCL_SYMMETRY_BUILD_TESTS)
    list(APPEND pcl_components io octree features filters visualization)
  endif()
  find_package(PCL 1.12 QUIET REQUIRED COMPONENTS ${pcl_components})
endif()
# The database of models. The core needs neither.
if(PCL_SYMMETRY_BUILD_PCL)
  find_package(SQLite3 3.37 REQUIRED)
  find_package(ZLIB REQUIRED)
endif()
if(NOT TARGET FLANN::FLANN)
  find_package(flann REQUIRED CONFIG)
  add_library(FLANN::FLANN INTERFACE IMPORTED)
  set_property(TARGET FLANN::FLANN PROPERTY INTERFACE_LINK_LIBRARIES flann::flann_cpp)
endif()

# Include directories and libraries of the named PCL components; installed targets get them from the imported targets.
function(pcl_symmetry_link_pcl target scope)
  target_include_directories(${target} SYSTEM ${scope} "$<BUILD_INTERFACE:${PCL_INCLUDE_DIRS}>")
  foreach(component IN LISTS ARGN)
    string(TOUPPER ${component} upper)
    target_link_libraries(${target} ${scope} ${PCL_${upper}_LIBRARIES})
  endforeach()
endfunction()
