# What of clgi is installed: a component a library, each with its own export set, its own file for
# find_package and its own pkg-config file, so that one can be left out without the others knowing.
#
#   clgi_library(target component
#       HEADERS path...         below include/clgi: files, or folders taken whole
#       [FINDS package...]      packages that its headers need, as find_dependency takes them
#       [LINKS package...]      the same, needed only beside a static library
#       [LINK_MODULES "NAME module"...]  pkg-config modules linked as PkgConfig::NAME, likewise
#       [PC_FINDS module...]    FINDS for pkg-config
#       [PC_LINKS module...]    LINKS for pkg-config
#       [PC_LIBS flag...])      linker flags needed only beside a static library
#
# The component `core` is clgi::clgi itself; all others stand on it. clgi_install_package() ends it.

include(CMakePackageConfigHelpers)
set(CLGI_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/clgi)
set(CLGI_COMPONENTS "")
# Before 1.0 a minor version may change the interface, so it is part of the name of the library.
set(CLGI_SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

function(clgi_library target component)
    cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "HEADERS;FINDS;LINKS;LINK_MODULES;PC_FINDS;PC_LINKS;PC_LIBS")
    if(NOT component STREQUAL core)
        add_library(clgi::${component} ALIAS ${target})
        set_target_properties(${target} PROPERTIES EXPORT_NAME ${component})
    endif()
    set_target_properties(${target} PROPERTIES
        VERSION ${PROJECT_VERSION} SOVERSION ${CLGI_SOVERSION})
    # What is public says so (clgi/export.hpp); nothing else leaves a shared library. Built with the
    # tests it shows all of itself, as they call what is inside.
    if(NOT CLGI_TESTS)
        set_target_properties(${target} PROPERTIES
            CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    endif()

    install(TARGETS ${target} EXPORT clgi-${component}
            RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime
                    NAMELINK_COMPONENT development
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
    install(EXPORT clgi-${component} NAMESPACE clgi:: FILE clgi-${component}-targets.cmake
            DESTINATION ${CLGI_CONFIG_DIR} COMPONENT development)
    foreach(header IN LISTS arg_HEADERS)
        get_filename_component(folder "clgi/${header}" DIRECTORY)
        if(IS_DIRECTORY "${PROJECT_SOURCE_DIR}/include/clgi/${header}")
            install(DIRECTORY include/clgi/${header} COMPONENT development
                    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder})
        else()
            install(FILES include/clgi/${header} COMPONENT development
                    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder})
        endif()
    endforeach()

    get_target_property(type ${target} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
        list(APPEND arg_FINDS ${arg_LINKS})
    else()
        set(arg_LINK_MODULES "")
        set(arg_PC_LINKS "")
        set(arg_PC_LIBS "")
    endif()
    clgi_write_config(${component} "${arg_FINDS}" "${arg_LINK_MODULES}")
    clgi_write_pkgconfig(${target} ${component} "${arg_PC_FINDS}" "${arg_PC_LINKS}" "${arg_PC_LIBS}")
    set(CLGI_COMPONENTS ${CLGI_COMPONENTS} ${component} PARENT_SCOPE)
endfunction()

# clgi-<component>.cmake: what clgiConfig.cmake includes for it.
function(clgi_write_config component finds modules)
    set(text "")
    foreach(package IN LISTS finds)
        string(APPEND text "find_dependency(${package})\n")
    endforeach()
    foreach(module IN LISTS modules)
        string(REPLACE " " ";" names "${module}")
        list(GET names 0 target)
        list(GET names 1 name)
        string(APPEND text "find_dependency(PkgConfig)\n"
               "pkg_check_modules(${target} QUIET IMPORTED_TARGET ${name})\n"
               "if(NOT ${target}_FOUND)\n"
               "    set(clgi_FOUND FALSE)\n"
               "    set(clgi_NOT_FOUND_MESSAGE \"clgi::${component} needs ${name}, which pkg-config does not find\")\n"
               "    return()\n"
               "endif()\n")
    endforeach()
    string(APPEND text "include(\"\${CMAKE_CURRENT_LIST_DIR}/clgi-${component}-targets.cmake\")\n")
    set(file "${PROJECT_BINARY_DIR}/clgi-${component}.cmake")
    file(WRITE "${file}" "${text}")
    install(FILES "${file}" DESTINATION ${CLGI_CONFIG_DIR} COMPONENT development)
endfunction()

# clgi.pc for the core, clgi-<component>.pc for the others. They find the prefix from where they lie.
function(clgi_write_pkgconfig target component finds links libs)
    set(pc_name clgi)
    if(NOT component STREQUAL core)
        set(pc_name clgi-${component})
        list(PREPEND finds "clgi = ${PROJECT_VERSION}")
    endif()
    set(folder "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
    file(RELATIVE_PATH pc_prefix "/${folder}" "/")
    string(REGEX REPLACE "/$" "" pc_prefix "${pc_prefix}")
    get_target_property(pc_library ${target} OUTPUT_NAME)
    if(NOT pc_library)
        set(pc_library ${target})
    endif()
    get_target_property(definitions ${target} INTERFACE_COMPILE_DEFINITIONS)
    set(pc_cflags "")
    if(definitions)
        list(TRANSFORM definitions PREPEND " -D" OUTPUT_VARIABLE pc_cflags)
        list(JOIN pc_cflags "" pc_cflags)
    endif()
    list(JOIN finds ", " pc_finds)
    list(JOIN links ", " pc_links)
    list(JOIN libs " " pc_libs)
    set(file "${PROJECT_BINARY_DIR}/${pc_name}.pc")
    configure_file("${PROJECT_SOURCE_DIR}/cmake/clgi.pc.in" "${file}" @ONLY)
    install(FILES "${file}" DESTINATION ${folder} COMPONENT development)
endfunction()

# The files that name all components, and the kernels as source.
function(clgi_install_package)
    list(JOIN CLGI_COMPONENTS ", " CLGI_COMPONENT_TEXT)
    configure_package_config_file(cmake/clgiConfig.cmake.in "${PROJECT_BINARY_DIR}/clgiConfig.cmake"
                                  INSTALL_DESTINATION ${CLGI_CONFIG_DIR})
    write_basic_package_version_file("${PROJECT_BINARY_DIR}/clgiConfigVersion.cmake"
                                     COMPATIBILITY SameMinorVersion)
    install(FILES "${PROJECT_BINARY_DIR}/clgiConfig.cmake"
                  "${PROJECT_BINARY_DIR}/clgiConfigVersion.cmake"
            DESTINATION ${CLGI_CONFIG_DIR} COMPONENT development)
    install(DIRECTORY "${PROJECT_BINARY_DIR}/kernels/" COMPONENT development
            DESTINATION ${CMAKE_INSTALL_DATADIR}/clgi/kernels FILES_MATCHING PATTERN "*.cl")
endfunction()
