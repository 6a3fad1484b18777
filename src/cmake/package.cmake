# A Debian package of all that is installed, by cpack: ./dev package.

if(NOT CMAKE_INSTALL_PREFIX STREQUAL /usr)
  return()
endif()
# As Debian's tools ask who makes a package.
set(maintainer "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
if("$ENV{DEBEMAIL}" STREQUAL "")
  set(maintainer "arcslip authors <arcslip@example.org>")
endif()
set(package_folder ${PROJECT_BINARY_DIR}/package)

file(READ LICENSE copyright)
if(EXISTS ${plotly_folder}/LICENSE)
  file(READ ${plotly_folder}/LICENSE plotly_license)
  string(APPEND copyright "\n/usr/share/arcslip/report/plotly-basic.min.js, plotly.js:\n\n${plotly_license}")
endif()
file(WRITE ${package_folder}/copyright "${copyright}")
install(FILES ${package_folder}/copyright DESTINATION share/doc/arcslip)

# The same sources make the same package: the date is that of SOURCE_DATE_EPOCH, else of the last commit.
if("$ENV{SOURCE_DATE_EPOCH}" STREQUAL "")
  execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} log -1 --format=%ct OUTPUT_VARIABLE last_commit
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE no_commit)
  if(no_commit EQUAL 0)
    set(ENV{SOURCE_DATE_EPOCH} ${last_commit})
  endif()
endif()
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${package_folder}/changelog "arcslip (${PROJECT_VERSION}) unstable; urgency=medium

  * The changes are told in the manual.

 -- ${maintainer}  ${date}
")
execute_process(COMMAND gzip -9nkf ${package_folder}/changelog COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${package_folder}/changelog.gz DESTINATION share/doc/arcslip)

# Python compiles the module where it is installed, and what it compiled goes with it.
file(WRITE ${package_folder}/postinst "#!/bin/sh
set -e
if [ \"$1\" = configure ]; then py3compile -p arcslip; fi
")
file(WRITE ${package_folder}/prerm "#!/bin/sh
set -e
py3clean -p arcslip
")
file(CHMOD ${package_folder}/postinst ${package_folder}/prerm
     PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${maintainer}")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
math(EXPR next_python "${Python_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_python}), python3-numpy")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS python3-matplotlib)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "libboost-dev, libeigen3-dev, libfmt-dev, libmetis-dev, libopenblas-dev, libsqlite3-dev, libsuitesparse-dev, libsuperlu-dev, nlohmann-json3-dev")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA "${package_folder}/postinst;${package_folder}/prerm")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "continuation of vibrations damped by dry friction")
set(CPACK_PACKAGE_DESCRIPTION "Traces the forced response of structures with dry friction through
stick, slip and folds, and finds the best preload of friction dampers.
Holds the program, its C++ library and the Python module.")
include(CPack)
