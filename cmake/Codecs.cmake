# The codecs of glTF's extensions: for each that is ON its library, for each that is OFF one file less.
# Changes CLGI_IO_SOURCES; sets CLGI_CODEC_... for targets and for what an installed clgi needs.

set(CLGI_CODEC_DEFINITIONS CLGI_HAS_MESHOPT=$<BOOL:${CLGI_MESHOPT}>
    CLGI_HAS_DRACO=$<BOOL:${CLGI_DRACO}> CLGI_HAS_WEBP=$<BOOL:${CLGI_WEBP}>)
set(CLGI_CODEC_TARGETS "")
set(CLGI_CODEC_LINKS "")
set(CLGI_CODEC_LINK_MODULES "")
set(CLGI_CODEC_PC_LINKS "")
set(CLGI_CODEC_PC_LIBS "")

if(CLGI_MESHOPT)
    find_package(meshoptimizer CONFIG REQUIRED)
    list(APPEND CLGI_CODEC_TARGETS meshoptimizer::meshoptimizer)
    list(APPEND CLGI_CODEC_LINKS meshoptimizer)
    list(APPEND CLGI_CODEC_PC_LIBS -lmeshoptimizer)
else()
    list(FILTER CLGI_IO_SOURCES EXCLUDE REGEX "/gltf_meshopt\\.cpp$")
endif()

if(CLGI_DRACO)
    find_package(draco CONFIG REQUIRED)
    list(APPEND CLGI_CODEC_TARGETS draco::draco)
    list(APPEND CLGI_CODEC_LINKS draco)
    list(APPEND CLGI_CODEC_PC_LINKS draco)
else()
    list(FILTER CLGI_IO_SOURCES EXCLUDE REGEX "/gltf_draco(_decoder)?\\.cpp$")
endif()

if(CLGI_WEBP)
    find_package(PkgConfig REQUIRED)
    pkg_check_modules(CLGI_LIBWEBP REQUIRED IMPORTED_TARGET libwebp)
    list(APPEND CLGI_CODEC_TARGETS PkgConfig::CLGI_LIBWEBP)
    list(APPEND CLGI_CODEC_LINK_MODULES "CLGI_LIBWEBP libwebp")
    list(APPEND CLGI_CODEC_PC_LINKS libwebp)
else()
    list(FILTER CLGI_IO_SOURCES EXCLUDE REGEX "/gltf_webp\\.cpp$")
endif()
