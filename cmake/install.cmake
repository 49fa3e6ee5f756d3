# SPDX-FileCopyrightText: 2026 The libscan authors
# SPDX-License-Identifier: Apache-2.0
# `cmake --install`: the program, the libraries with their headers, and what find_package(libscan) reads.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(LIBSCAN_CMAKE_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/libscan)
install(TARGETS scan RUNTIME)
install(DIRECTORY libscan synth DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT libscanTargets NAMESPACE libscan:: DESTINATION ${LIBSCAN_CMAKE_FOLDER})
configure_package_config_file(cmake/libscanConfig.cmake.in libscanConfig.cmake
                              INSTALL_DESTINATION ${LIBSCAN_CMAKE_FOLDER})
write_basic_package_version_file(libscanConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/libscanConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/libscanConfigVersion.cmake
        DESTINATION ${LIBSCAN_CMAKE_FOLDER})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
