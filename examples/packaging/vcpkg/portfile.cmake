# An overlay port for a checkout: vcpkg install cambium --overlay-ports=cambium/examples/packaging/vcpkg
get_filename_component(SOURCE_PATH "${CURRENT_PORT_DIR}/../../.." ABSOLUTE)
set(VCPKG_BUILD_TYPE release)  # headers only
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS -DCAMBIUM_BUILD_TESTS=OFF -DCAMBIUM_BUILD_BENCH=OFF -DCAMBIUM_BUILD_EXAMPLES=OFF -DCAMBIUM_MPI=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH share/cmake/cambium)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/share/doc")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
