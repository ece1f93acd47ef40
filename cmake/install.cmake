# Installs headers, libraries and the package that find_package(matstruct) finds; its target is matstruct::matstruct.
include(CMakePackageConfigHelpers)

set(MATSTRUCT_PACKAGE_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/matstruct)
get_property(layers GLOBAL PROPERTY MATSTRUCT_LAYER_TARGETS)

install(TARGETS matstruct matstruct_flags ${layers} EXPORT matstruct_targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT matstruct_targets NAMESPACE matstruct:: FILE matstruct-targets.cmake DESTINATION ${MATSTRUCT_PACKAGE_FOLDER})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/matstruct ${PROJECT_BINARY_DIR}/include/matstruct
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")

configure_package_config_file(cmake/matstruct-config.cmake.in ${PROJECT_BINARY_DIR}/matstruct-config.cmake
                              INSTALL_DESTINATION ${MATSTRUCT_PACKAGE_FOLDER})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/matstruct-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/matstruct-config.cmake ${PROJECT_BINARY_DIR}/matstruct-config-version.cmake
        DESTINATION ${MATSTRUCT_PACKAGE_FOLDER})
