# Install and export, so that a project says find_package(luxel) and links luxel::solver, luxel::io ...
include(CMakePackageConfigHelpers)

set(luxel_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/luxel)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/luxelConfig.cmake.in
  ${PROJECT_BINARY_DIR}/luxelConfig.cmake INSTALL_DESTINATION ${luxel_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/luxelConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/luxelConfig.cmake ${PROJECT_BINARY_DIR}/luxelConfigVersion.cmake
        DESTINATION ${luxel_package_dir})
install(EXPORT luxel NAMESPACE luxel:: FILE luxelTargets.cmake DESTINATION ${luxel_package_dir})
