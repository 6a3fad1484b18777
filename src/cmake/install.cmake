# What is installed: libraries, headers, program, what it reads, and the packages for CMake and pkg-config.

install(TARGETS arcslip arcslip_base arcslip_continuation arcslip_mechanics arcslip_problems arcslip_files
        EXPORT arcslipTargets)
install(TARGETS arcslip_program)
install(DIRECTORY include/arcslip ${PROJECT_BINARY_DIR}/include/arcslip DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY plots/ DESTINATION share/arcslip/plots
        FILES_MATCHING PATTERN "*.py" PATTERN "report*.html" PATTERN "report*.css" PATTERN "report*.js")
install(DIRECTORY ${plotly_folder} DESTINATION share/arcslip OPTIONAL FILES_MATCHING PATTERN "*.js")
if(NOT CMAKE_INSTALL_PREFIX STREQUAL /usr)  # where Debian wants all in one file, see package.cmake
  install(FILES ${plotly_folder}/LICENSE DESTINATION share/arcslip/report OPTIONAL)
endif()
file(GLOB case_files CONFIGURE_DEPENDS problems/*.toml)
install(FILES ${case_files} DESTINATION share/arcslip/problems)
install(DIRECTORY problems/export problems/nlvib DESTINATION share/arcslip/problems)
if(NOT CMAKE_INSTALL_PREFIX STREQUAL /usr)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
endif()

# ---- For CMake: a component is a layer with those below it, and asks for what these need ----

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/arcslip)
string(REPLACE ";" " " dense "${dense_libraries}")
string(REPLACE ";" " " libraries_of_sectors "${sector_libraries}")
file(CONFIGURE OUTPUT arcslipConfig.cmake @ONLY CONTENT [[
set(arcslip_components continuation mechanics problems files)
set(arcslip_wanted ${arcslip_FIND_COMPONENTS})
if(NOT arcslip_wanted)
  set(arcslip_wanted ${arcslip_components})
endif()
@find_sparse@
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4)
find_dependency(Boost 1.74)
find_dependency(fmt)
arcslip_find(lapack "" "" @dense@)
arcslip_find(suitesparse klu.h suitesparse klu amd colamd btf suitesparseconfig)
if("mechanics" IN_LIST arcslip_wanted OR "problems" IN_LIST arcslip_wanted OR "files" IN_LIST arcslip_wanted)
  arcslip_find(superlu slu_zdefs.h superlu @libraries_of_sectors@)
endif()
if("files" IN_LIST arcslip_wanted)
  find_dependency(nlohmann_json)
  find_dependency(SQLite3)
  find_dependency(Threads)
endif()
include(${CMAKE_CURRENT_LIST_DIR}/arcslipTargets.cmake)
foreach(component IN LISTS arcslip_FIND_COMPONENTS)
  if(component IN_LIST arcslip_components)
    set(arcslip_${component}_FOUND TRUE)
  elseif(arcslip_FIND_REQUIRED_${component})
    set(arcslip_FOUND FALSE)
    set(arcslip_NOT_FOUND_MESSAGE "There is no component ${component} among ${arcslip_components}.")
  endif()
endforeach()
]])
write_basic_package_version_file(arcslipConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT arcslipTargets NAMESPACE arcslip:: DESTINATION ${package_dir})
install(FILES ${PROJECT_BINARY_DIR}/arcslipConfig.cmake ${PROJECT_BINARY_DIR}/arcslipConfigVersion.cmake
        DESTINATION ${package_dir})

# ---- For pkg-config, which wants a list of libraries instead of a package ----

list(JOIN eigen_memory " -D" eigen_definitions)
list(JOIN dense_libraries " -l" flags_of_dense)
list(JOIN sector_libraries " -l" flags_of_sectors)
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
           OUTPUT_VARIABLE to_prefix)

# arcslip_pkg_config(name what requires libraries)
function(arcslip_pkg_config name what requires libraries)
  string(CONFIGURE [[
prefix=${pcfiledir}/@to_prefix@
Name: @name@
Description: @what@
Version: @PROJECT_VERSION@
Requires: @requires@
Cflags: -I${prefix}/@CMAKE_INSTALL_INCLUDEDIR@ -D@eigen_definitions@
Libs: -L${prefix}/@CMAKE_INSTALL_LIBDIR@ @libraries@
]] text @ONLY)
  file(WRITE ${PROJECT_BINARY_DIR}/${name}.pc "${text}")
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()

arcslip_pkg_config(arcslip-continuation "Continuation and bifurcation of problems that are smooth in pieces"
  "eigen3 >= 3.4 fmt" "-larcslip_continuation -larcslip_base -lklu -lamd -lcolamd -lbtf -lsuitesparseconfig -l${flags_of_dense}")
arcslip_pkg_config(arcslip "${PROJECT_DESCRIPTION}" "arcslip-continuation nlohmann_json sqlite3"
  "-larcslip_files -larcslip_problems -larcslip_continuation -larcslip_mechanics -larcslip_base -l${flags_of_sectors} -pthread")
