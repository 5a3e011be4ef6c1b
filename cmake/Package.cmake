# Debian packages: `cpack -G DEB` in the build folder makes clgi (program and shared libraries) and
# libclgi-dev (headers, CMake and pkg-config files, kernels, static libraries).

set(CPACK_PACKAGE_NAME clgi)
set(CPACK_PACKAGE_VENDOR clgi)
set(CPACK_PACKAGE_CONTACT "clgi maintainers" CACHE STRING "Maintainer field of packages")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_GENERATOR DEB)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime development)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_PACKAGE_HOMEPAGE "${PROJECT_HOMEPAGE_URL}")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME clgi)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "${PROJECT_DESCRIPTION}: program and shared libraries")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libclgi-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "clgi (= ${PROJECT_VERSION}), ocl-icd-opencl-dev, opencl-clhpp-headers, libglm-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS  # of static libraries
    "libopenexr-dev, libpng-dev, libmeshoptimizer-dev, libdraco-dev, libwebp-dev, libepoxy-dev, pkg-config, libembree-dev, libtbb-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "${PROJECT_DESCRIPTION}: headers and kernel sources")
include(CPack)
