# What the project links. PCL 1.13 exports no imported targets, so its variables are wrapped in one here; flann.pc drags
# in MPI and HDF5, so FLANN comes from the target that PCL's own finder defines.
find_package(Eigen3 3.3 REQUIRED NO_MODULE)
find_package(Boost REQUIRED)  # headers: Boost.Graph
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(PCL 1.12 QUIET REQUIRED COMPONENTS common io search kdtree features filters registration segmentation visualization)
if(NOT TARGET FLANN::FLANN)
  find_package(FLANN REQUIRED)
endif()

# Include directories and libraries of the named PCL components; installed targets get them from the imported targets.
function(pcl_symmetry_link_pcl target scope)
  target_include_directories(${target} SYSTEM ${scope} "$<BUILD_INTERFACE:${PCL_INCLUDE_DIRS}>")
  foreach(component IN LISTS ARGN)
    string(TOUPPER ${component} upper)
    target_link_libraries(${target} ${scope} ${PCL_${upper}_LIBRARIES})
  endforeach()
endfunction()
