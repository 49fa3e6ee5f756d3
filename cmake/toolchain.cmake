# SPDX-FileCopyrightText: 2026 The libscan authors
# SPDX-License-Identifier: Apache-2.0
# Compiler, cache and linker. One instruction set for the whole program: Debian's PCL is built for
# the amd64 baseline, and Eigen types change their layout with AVX, silently.
foreach(flags CMAKE_CXX_FLAGS CMAKE_CXX_FLAGS_RELEASE CMAKE_CXX_FLAGS_DEBUG)
  if("${${flags}}" MATCHES "-march=(native|x86-64-v[34])|-mavx|-ffast-math")
    message(FATAL_ERROR "${flags} holds '${CMAKE_MATCH_0}', which changes Eigen's layout against "
                        "Debian's PCL or breaks exact arithmetic; remove it")
  endif()
endforeach()

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(LIBSCAN_CCACHE ccache)
if(LIBSCAN_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${LIBSCAN_CCACHE})
endif()
find_program(LIBSCAN_MOLD mold)
if(LIBSCAN_MOLD)
  add_link_options(-fuse-ld=mold)
endif()
if(LIBSCAN_TIDY)
  find_program(LIBSCAN_CLANG_TIDY clang-tidy REQUIRED)
  set(CMAKE_CXX_CLANG_TIDY ${LIBSCAN_CLANG_TIDY})
endif()
# g++'s AddressSanitizer makes Eigen choose its own allocator; PCL's objects expect malloc's.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_FLAGS_DEBUG MATCHES "-fsanitize=address")
  add_compile_definitions(EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()
# x87 never, fused multiply-add never behind our back: the same bytes from each compiler level.
add_compile_options(-ffp-contract=off)
