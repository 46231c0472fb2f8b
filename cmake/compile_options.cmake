# How everything in the project is compiled. No -march=native and no -ffast-math: both change PCL's ABI or our numbers.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Precompiled headers make ccache ask for this.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
endif()

if(PCL_SYMMETRY_SANITIZE)
  add_compile_options(-fsanitize=${PCL_SYMMETRY_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(PCL_SYMMETRY_SANITIZE MATCHES undefined)
    # Null addresses end in a signal anyway, those beyond an array in the address sanitizer; unaligned ones and wrong dynamic
    # types are not looked for. measured: checking each access for null, alignment and type takes half as much time again to
    # compile (core/detection: half as long again), checking the arithmetic of pointers a tenth.
    add_compile_options(-fno-sanitize=null,alignment,vptr,pointer-overflow)
  endif()
  # The address sanitizer opens the modules of the tools in their place: only the older form of the path in the program
  # is searched whoever asks.
  add_link_options(-fsanitize=${PCL_SYMMETRY_SANITIZE} -Wl,--disable-new-dtags)
  # Eigen changes its allocation under the address sanitizer; PCL's libraries, compiled without, free what we allocate.
  add_compile_definitions(EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()

# libFuzzer: everything is compiled so that it tells the fuzzer which branches an input took.
if(PCL_SYMMETRY_BUILD_FUZZERS)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES Clang)
    message(FATAL_ERROR "PCL_SYMMETRY_BUILD_FUZZERS = ON, must be compiled with Clang: cmake --preset fuzz")
  endif()
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# Warnings for our own targets only.
add_library(pcl_symmetry_warnings INTERFACE)
target_compile_options(pcl_symmetry_warnings INTERFACE -Wall -Wextra -Wshadow -Wnon-virtual-dtor)

# For tools and tests, whose time goes into the libraries: -O1 takes a quarter less time to compile than -O3.
add_library(pcl_symmetry_quick_compile INTERFACE)
target_compile_options(pcl_symmetry_quick_compile INTERFACE $<$<CONFIG:Release>:-O1>)

# With CMAKE_UNITY_BUILD (presets release, sanitize and thread) up to ten sources of a folder are compiled as one file: what
# they include and the templates that they share are compiled once. Without it (preset debug) each source has to name what
# it includes.
function(pcl_symmetry_unite_folders target)
  get_target_property(sources ${target} SOURCES)
  list(SORT sources)
  foreach(source IN LISTS sources)
    get_filename_component(folder ${source} ABSOLUTE)
    get_filename_component(folder ${folder} DIRECTORY)
    file(RELATIVE_PATH folder ${CMAKE_CURRENT_SOURCE_DIR} ${folder})
    string(MAKE_C_IDENTIFIER "folder_${folder}" group)
    if(NOT DEFINED num_${group})
      set(num_${group} 0)
    endif()
    math(EXPR part "${num_${group}} / 10")
    math(EXPR num_${group} "${num_${group}} + 1")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group}_${part})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
endfunction()
