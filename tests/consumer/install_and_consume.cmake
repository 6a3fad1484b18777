# Installs the build to a fresh prefix, builds the consumers beside it against that prefix, and runs all.
set(work ${BUILD_DIR}/install_and_consume)
set(prefix ${work}/prefix)
file(REMOVE_RECURSE ${work})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --config ${CONFIG} --prefix ${prefix})
run(${prefix}/${BINDIR}/arcslip --version)
# Pictures are drawn by what is installed.
run(${prefix}/${BINDIR}/arcslip run ${prefix}/share/arcslip/problems/cusp.toml -o ${work}/cusp --quiet)
run(${prefix}/${BINDIR}/arcslip plot ${work}/cusp)
file(GLOB pictures ${work}/cusp/*.png)
if(NOT pictures)
  message(FATAL_ERROR "the installed program drew nothing")
endif()

function(build name)
  run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${work}/${name} -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${prefix}
      -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
      -DCMAKE_RUNTIME_OUTPUT_DIRECTORY=${work}/${name}/bin ${ARGN})
  run(${CMAKE_COMMAND} --build ${work}/${name} --config ${CONFIG})
endfunction()

build(plain)
set(plain ${work}/plain/bin)
run(${plain}/friction)
run(${plain}/further)

# Without CMake
find_program(PKG_CONFIG pkg-config REQUIRED)
file(GLOB_RECURSE descriptions ${prefix}/*/arcslip.pc)
cmake_path(GET descriptions PARENT_PATH folder)
foreach(pair IN ITEMS "arcslip friction" "arcslip-continuation own_problem")
  separate_arguments(pair)
  list(POP_FRONT pair package source)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${folder} ${PKG_CONFIG} --cflags --libs ${package}
                  OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  if(package STREQUAL arcslip-continuation AND flags MATCHES "sqlite|superlu|umfpack|mechanics")
    message(FATAL_ERROR "pkg-config links the engine to more than it needs: ${flags}")
  endif()
  separate_arguments(flags UNIX_COMMAND "${flags}")
  run(${CXX_COMPILER} -std=c++20 ${CMAKE_CURRENT_LIST_DIR}/${source}.cpp ${flags} -o ${work}/${source})
  run(${work}/${source})
endforeach()

# At k = 1/5 the arch snaps at u = 1 -+ sqrt(1/5), d = 1 +- sqrt(1/5).
execute_process(COMMAND ${plain}/own_problem OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
message(STATUS "${output}")
foreach(expected IN ITEMS "fold: d = 1.44721, u = 0.552786\n" "fold: d = 0.552786, u = 1.44721\n")
  string(FIND "${output}" "${expected}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "own_problem did not print: ${expected}")
  endif()
endforeach()

# The manual shows all of it; how exact differences are depends on the compiler.
file(READ ${CMAKE_CURRENT_LIST_DIR}/../../src/manual/pages/cpp.md page)
foreach(text IN ITEMS output page)
  string(REGEX REPLACE "exact to [0-9.e-]+" "exact to E" ${text} "${${text}}")
endforeach()
string(REGEX REPLACE "([^\n]+\n)" "    \\1" shown "${output}")
string(FIND "${page}" "\n\n${shown}\n" at)
if(at EQUAL -1)
  message(FATAL_ERROR "the manual does not show:\n${shown}")
endif()

# Matrices pass between the library and users that are built for other instructions, or with the address sanitizer.
set(flags -fsanitize=address)
execute_process(COMMAND ${CXX_COMPILER} -march=native -E -x c++ /dev/null RESULT_VARIABLE refused OUTPUT_QUIET ERROR_QUIET)
if(refused EQUAL 0)
  set(flags "${flags} -march=native")
endif()
build(other "-DCMAKE_CXX_FLAGS=${flags}")
run(${work}/other/bin/own_problem)
run(${work}/other/bin/further)

# Components are the layers, and no others.
file(WRITE ${work}/components/CMakeLists.txt [[
cmake_minimum_required(VERSION 3.25)
project(components LANGUAGES CXX)
find_package(arcslip QUIET COMPONENTS continuation nonsense)
if(arcslip_FOUND OR NOT arcslip_continuation_FOUND)
  message(FATAL_ERROR "a component that is not there was found")
endif()
find_package(arcslip QUIET OPTIONAL_COMPONENTS nonsense)
if(NOT arcslip_FOUND OR arcslip_nonsense_FOUND)
  message(FATAL_ERROR "an optional component that is not there was found")
endif()
find_package(arcslip REQUIRED COMPONENTS continuation mechanics problems files)
]])
run(${CMAKE_COMMAND} -S ${work}/components -B ${work}/components/build -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_CXX_COMPILER=${CXX_COMPILER})

# The engine alone, where there is none of what only the others need.
file(WRITE ${work}/engine/CMakeLists.txt "
cmake_minimum_required(VERSION 3.25)
project(engine LANGUAGES CXX)
find_package(arcslip REQUIRED COMPONENTS continuation)
if(TARGET arcslip::superlu OR TARGET SQLite::SQLite3 OR TARGET nlohmann_json::nlohmann_json)
  message(FATAL_ERROR \"the engine alone asks for more than it needs\")
endif()
add_executable(engine ${CMAKE_CURRENT_LIST_DIR}/own_problem.cpp)
target_link_libraries(engine PRIVATE arcslip::continuation)
")
run(${CMAKE_COMMAND} -S ${work}/engine -B ${work}/engine/build -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_DISABLE_FIND_PACKAGE_SQLite3=ON
    -DCMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON)
run(${CMAKE_COMMAND} --build ${work}/engine/build)
run(${work}/engine/build/engine)
