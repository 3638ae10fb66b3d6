# Installs the core alone: headers and a package configuration for find_package(surfgrad).
install(TARGETS surfgrad_core EXPORT surfgradTargets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/surfgrad DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT core)
set(SURFGRAD_CMAKE_DIR ${CMAKE_INSTALL_DATADIR}/cmake/surfgrad)
install(EXPORT surfgradTargets NAMESPACE surfgrad:: DESTINATION ${SURFGRAD_CMAKE_DIR} COMPONENT core)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/surfgradConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/surfgradConfig.cmake INSTALL_DESTINATION ${SURFGRAD_CMAKE_DIR})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/surfgradConfigVersion.cmake
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/surfgradConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/surfgradConfigVersion.cmake
  DESTINATION ${SURFGRAD_CMAKE_DIR} COMPONENT core)
