# The tests that docs/stability.md names as `file_test.Case`, as GoogleTest's filters.
#
#   clgi_stability_cases(SOURCE_DIR)      sets
#
#   CLGI_STABILITY_<module>          filter of the named cases of tests/<module>
#   CLGI_STABILITY_SUITES_<module>   all suites of the files that hold them
#   CLGI_STABILITY_FILES             these files
#   CLGI_STABILITY_COUNT             how many names there are
#   CLGI_STABILITY_FAULTS            names without a case

function(clgi_stability_cases source)
    file(READ "${source}/docs/stability.md" text)
    string(REGEX MATCHALL "`[a-z0-9_]+_test\\.[A-Za-z0-9]+`" names "${text}")
    list(REMOVE_DUPLICATES names)
    list(LENGTH names count)
    set(files "")
    set(modules "")
    set(faults "")
    foreach(name IN LISTS names)
        string(REGEX MATCH "([a-z0-9_]+)\\.([A-Za-z0-9]+)" name "${name}")
        set(stem "${CMAKE_MATCH_1}")
        set(case "${CMAKE_MATCH_2}")
        file(GLOB path "${source}/tests/*/${stem}.cpp")
        set(found "")
        if(path)
            file(STRINGS "${path}" found REGEX "^TEST(_P|_F)?\\([A-Za-z0-9]+, *${case}\\)")
        endif()
        if(NOT found)
            string(APPEND faults "\n  ${name}")
            continue()
        endif()
        list(APPEND files "${path}")
        file(STRINGS "${path}" suites REGEX "^TEST(_P|_F)?\\(")
        list(TRANSFORM suites REPLACE "^TEST[_PF]*\\(([A-Za-z0-9]+),.*" "\\1")
        get_filename_component(module "${path}" DIRECTORY)
        get_filename_component(module "${module}" NAME)
        list(APPEND modules ${module})
        list(APPEND suites_${module} ${suites})
        foreach(line IN LISTS found)
            string(REGEX MATCH "^TEST(_P)?[_F]*\\(([A-Za-z0-9]+)," line "${line}")
            if(CMAKE_MATCH_1)  # <instance>/<suite>.<case>/<parameter>
                list(APPEND filter_${module} "*/${CMAKE_MATCH_2}.${case}/*")
            else()
                list(APPEND filter_${module} "${CMAKE_MATCH_2}.${case}")
            endif()
        endforeach()
    endforeach()
    list(REMOVE_DUPLICATES modules)
    foreach(module IN LISTS modules)
        string(REPLACE ";" ":" filter "${filter_${module}}")
        set(CLGI_STABILITY_${module} "${filter}" PARENT_SCOPE)
        list(REMOVE_DUPLICATES suites_${module})
        set(CLGI_STABILITY_SUITES_${module} "${suites_${module}}" PARENT_SCOPE)
    endforeach()
    list(REMOVE_DUPLICATES files)
    set(CLGI_STABILITY_FILES "${files}" PARENT_SCOPE)
    set(CLGI_STABILITY_COUNT ${count} PARENT_SCOPE)
    set(CLGI_STABILITY_FAULTS "${faults}" PARENT_SCOPE)
endfunction()
