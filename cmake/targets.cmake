# SPDX-FileCopyrightText: 2026 The libscan authors
# SPDX-License-Identifier: Apache-2.0

# g++ 12 warns falsely of -Wrestrict when texts are joined (GCC PR105651).
set(LIBSCAN_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                     -Wno-missing-field-initializers $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)

# scan_add_library(NAME SOURCES... PUBLIC targets... PRIVATE targets...): the target scan_NAME with
# the alias libscan::NAME. Foreign headers count as system headers: our warnings are for our code.
function(scan_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(scan_${name} STATIC ${ARG_SOURCES})
  add_library(libscan::${name} ALIAS scan_${name})
  target_include_directories(scan_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                 $<INSTALL_INTERFACE:include>)
  target_link_libraries(scan_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  target_compile_options(scan_${name} PRIVATE ${LIBSCAN_WARNINGS})
  set_target_properties(scan_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS scan_${name} EXPORT libscanTargets)
endfunction()

# scan_kernel_source(files...): loops for vector instructions (libscan/core/instruction_sets.h). Each
# product is rounded by itself, which keeps the bytes independent of the instruction set.
function(scan_kernel_source)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS
                              "-ffp-contract=off;-fno-math-errno;-fno-trapping-math")
endfunction()

# scan_add_test(NAME SOURCES... LIBS targets...): one GoogleTest program, each of its tests in ctest.
function(scan_add_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} GTest::gtest_main)
  target_compile_options(${name} PRIVATE ${LIBSCAN_WARNINGS})
  target_compile_definitions(${name} PRIVATE LIBSCAN_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                             LIBSCAN_BINARY_DIR="${PROJECT_BINARY_DIR}")
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  math(EXPR timeout "${ARG_TIMEOUT} * ${LIBSCAN_TIMEOUT_FACTOR}")
  include(GoogleTest)
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${timeout})
endfunction()
