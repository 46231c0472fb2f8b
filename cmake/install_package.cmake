# What `cmake --install` puts down: headers, libraries, find_package(pcl_symmetry) and pkg-config files.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pcl_symmetry)

# Without the classes for PCL clouds, what is installed needs no PCL. Two export sets, so that programs can also have
# the core alone.
set(with_pcl OFF)
if(TARGET pcl_symmetry)
  set(with_pcl ON)
endif()
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)
# Of a shared library, programs need the component runtime alone.
set(parts_of_libraries LIBRARY COMPONENT runtime NAMELINK_COMPONENT development)
install(TARGETS pcl_symmetry_core EXPORT pcl_symmetry_core_targets ${parts_of_libraries})
install(EXPORT pcl_symmetry_core_targets NAMESPACE pcl_symmetry:: DESTINATION ${package_dir})
if(with_pcl)
  install(TARGETS pcl_symmetry EXPORT pcl_symmetry_pcl_targets ${parts_of_libraries})
  install(EXPORT pcl_symmetry_pcl_targets NAMESPACE pcl_symmetry:: DESTINATION ${package_dir})
  install(DIRECTORY include/pcl_symmetry DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")
else()
  install(DIRECTORY include/pcl_symmetry/core DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pcl_symmetry FILES_MATCHING PATTERN "*.h")
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# Libraries that a static core leaves to the programs that link it; a shared core has linked them.
get_target_property(core_type pcl_symmetry_core TYPE)
set(static_core OFF)
set(core_link_flags "")
set(face_link_flags "")
if(core_type STREQUAL STATIC_LIBRARY)
  set(static_core ON)
  set(face_link_flags " -lsqlite3 -lz")
  set(core_link_flags "-llz4 -pthread")
endif()
if(PCL_SYMMETRY_SANITIZE)
  string(APPEND core_link_flags " -fsanitize=${PCL_SYMMETRY_SANITIZE}")
endif()

configure_package_config_file(cmake/pcl_symmetry-config.cmake.in ${PROJECT_BINARY_DIR}/pcl_symmetry-config.cmake
                              INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pcl_symmetry-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pcl_symmetry-config.cmake ${PROJECT_BINARY_DIR}/pcl_symmetry-config-version.cmake
        DESTINATION ${package_dir})

# Paths relative to the .pc file where the installation can be moved.
if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}" OR IS_ABSOLUTE "${CMAKE_INSTALL_INCLUDEDIR}")
  set(pc_prefix "${CMAKE_INSTALL_PREFIX}")
  set(pc_libdir "${CMAKE_INSTALL_FULL_LIBDIR}")
  set(pc_includedir "${CMAKE_INSTALL_FULL_INCLUDEDIR}")
else()
  file(RELATIVE_PATH to_prefix "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
  string(REGEX REPLACE "/$" "" to_prefix "${to_prefix}")
  set(pc_prefix "\${pcfiledir}/${to_prefix}")
  set(pc_libdir "\${prefix}/${CMAKE_INSTALL_LIBDIR}")
  set(pc_includedir "\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}")
endif()
set(pc_names pcl_symmetry_core)
if(with_pcl)
  list(APPEND pc_names pcl_symmetry)
endif()
foreach(name IN LISTS pc_names)
  configure_file(cmake/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
