# vcpkg port: `vcpkg install ricci --overlay-ports=cmake/vcpkg`, of the tree that the port lies in.
get_filename_component(SOURCE_PATH ${CURRENT_PORT_DIR}/../.. ABSOLUTE)
# C knows no debug runtime, so that one build serves both.
set(VCPKG_BUILD_TYPE release)
set(VCPKG_POLICY_MISMATCHED_NUMBER_OF_BINARIES enabled)
vcpkg_cmake_configure(SOURCE_PATH ${SOURCE_PATH} OPTIONS -DRICCI_TESTS=OFF -DRICCI_EXAMPLES=OFF
  -DRICCI_CARGO_TARGET_DIR=${CURRENT_BUILDTREES_DIR}/cargo)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME ricci CONFIG_PATH lib/cmake/ricci)
vcpkg_fixup_pkgconfig()
if(VCPKG_LIBRARY_LINKAGE STREQUAL "dynamic")
  file(REMOVE ${CURRENT_PACKAGES_DIR}/lib/libricci.a)
else()
  file(GLOB _shared ${CURRENT_PACKAGES_DIR}/lib/libricci.*so* ${CURRENT_PACKAGES_DIR}/lib/libricci.*dylib)
  file(REMOVE ${_shared})
endif()
vcpkg_install_copyright(FILE_LIST ${SOURCE_PATH}/LICENSE-MIT ${SOURCE_PATH}/LICENSE-APACHE)
