# vcpkg port: `vcpkg install ricci --overlay-ports=cmake/vcpkg`, of the tree that the port lies in.
get_filename_component(SOURCE_PATH ${CURRENT_PORT_DIR}/../.. ABSOLUTE)
vcpkg_cmake_configure(SOURCE_PATH ${SOURCE_PATH} OPTIONS -DRICCI_TESTS=OFF -DRICCI_EXAMPLES=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME ricci CONFIG_PATH lib/cmake/ricci)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE ${CURRENT_PACKAGES_DIR}/debug/include ${CURRENT_PACKAGES_DIR}/debug/share)
vcpkg_install_copyright(FILE_LIST ${SOURCE_PATH}/LICENSE-MIT ${SOURCE_PATH}/LICENSE-APACHE)
