# What every target of facewire shares: language level, warnings, sanitizers, and the arrows.

option(FACEWIRE_BUILD_TESTS "Build tests and benchmarks" ON)
set(FACEWIRE_SANITIZE "" CACHE STRING "Sanitizers for everything, such as address,undefined or thread")
set(FACEWIRE_ASSETS "${PROJECT_SOURCE_DIR}/.assets" CACHE PATH
    "Where tools/setup unpacked the networks and the test footage")
# A program for another processor runs on an emulated one.
if(CMAKE_CROSSCOMPILING)
  set(FACEWIRE_TEST_TIMEOUT_S 7200)
else()
  set(FACEWIRE_TEST_TIMEOUT_S 600)
endif()

include(GNUInstallDirs)

# Modules, which a program loads when it needs them: where they are built and installed, and so where programs look.
set(FACEWIRE_MODULES "${PROJECT_BINARY_DIR}/modules")
set(FACEWIRE_INSTALLED_MODULES lib/facewire)
set(CMAKE_BUILD_RPATH "${FACEWIRE_MODULES}")
file(RELATIVE_PATH from_programs "/${CMAKE_INSTALL_BINDIR}" "/${FACEWIRE_INSTALLED_MODULES}")
set(CMAKE_INSTALL_RPATH "$ORIGIN/${from_programs}")

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wredundant-decls
                    "$<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor;-Woverloaded-virtual;-Wsuggest-override;-Wzero-as-null-pointer-constant>"
                    -Wconversion -Wno-sign-conversion -Werror)
if(FACEWIRE_SANITIZE)
  add_compile_options(-fsanitize=${FACEWIRE_SANITIZE} -fno-sanitize-recover=all
                      -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${FACEWIRE_SANITIZE})
  # core's classes with virtual functions have no type information, which this one check would look for.
  add_compile_options(-fno-sanitize=vptr)
  # A sanitizer's library comes between a program and dlopen, which then asks for that library's RUNPATH; RPATH is the
  # program's for every caller.
  add_link_options(-Wl,--disable-new-dtags)
  # GCC 12 finds std::regex and std::function uninitialised in instrumented code; they are not.
  add_compile_options(-Wno-maybe-uninitialized)
else()
  # What Debian builds its own programs with, in every preset: what is tested is what is installed. The sanitizers
  # see more than these do, and get in each other's way.
  include(CheckPIESupported)
  check_pie_supported()
  add_compile_options(-fstack-protector-strong -D_FORTIFY_SOURCE=2)
  add_link_options(-Wl,-z,relro,-z,now)
endif()
if(CMAKE_BUILD_TYPE STREQUAL "Release")
  # GCC 12 at -O3 sees overlapping copies inside std::string (its bug 105651).
  add_compile_options(-Wno-restrict)
endif()

# The arrows of the architecture, enforced by the compiler: a layer sees the source folders that it may
# include and no others, because each layer has an include root of links to just those folders.
#   core -> core          hal -> core          app -> hal, core          tools -> app, hal, core
function(facewire_include_root layer)
  set(root "${PROJECT_BINARY_DIR}/include/${layer}")
  file(MAKE_DIRECTORY "${root}")
  foreach(folder ${ARGN})
    file(CREATE_LINK "${PROJECT_SOURCE_DIR}/${folder}" "${root}/${folder}" SYMBOLIC)
  endforeach()
  set(FACEWIRE_INCLUDE_ROOT_${layer} "${root}" PARENT_SCOPE)
endfunction()
facewire_include_root(core core)
facewire_include_root(hal core hal)
facewire_include_root(app core hal app)
facewire_include_root(tools core hal app tools)
facewire_include_root(tests core hal app tools tests)

# facewire_read_once(TARGET HEADER... | REUSE_FROM TARGET): headers that many sources of a target include and that take the
# compiler seconds, read once; -fpch-preprocess lets a compiler cache see through them. tools/lint reads every source
# without, so a forgotten include is found there.
function(facewire_read_once target)
  if("${ARGV1}" STREQUAL "REUSE_FROM")
    target_precompile_headers(${target} REUSE_FROM ${ARGV2})
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
  target_compile_options(${target} PRIVATE -fpch-preprocess)
endfunction()

# facewire_library(NAME LAYER core|hal|app|tools SOURCES ... [DEPENDS ...])
# Targets of the core layer are built without exceptions and RTTI.
function(facewire_library name)
  cmake_parse_arguments(ARG "" "LAYER" "SOURCES;DEPENDS" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE "${FACEWIRE_INCLUDE_ROOT_${ARG_LAYER}}")
  target_link_libraries(${name} PUBLIC ${ARG_DEPENDS})
  if(ARG_LAYER STREQUAL "core")
    target_compile_options(${name} PRIVATE -fno-exceptions -fno-rtti)
  endif()
endfunction()

# What nearly every test includes. A test's own code is optimised little, which compiles faster; what it tests is built
# as the preset says.
set(FACEWIRE_TEST_OPTIONS -Og)
function(facewire_test_headers)
  set(source "${PROJECT_BINARY_DIR}/test_headers.cc")
  file(CONFIGURE OUTPUT "${source}" CONTENT "int main() {}\n")
  add_executable(facewire_test_headers EXCLUDE_FROM_ALL "${source}")
  target_compile_options(facewire_test_headers PRIVATE ${FACEWIRE_TEST_OPTIONS})
  target_link_libraries(facewire_test_headers PRIVATE GTest::gmock GTest::gtest_main)
  facewire_read_once(facewire_test_headers
    <gmock/gmock.h> <gtest/gtest.h> <algorithm> <array> <chrono> <cmath> <filesystem> <fstream> <functional> <map>
    <memory> <optional> <random> <sstream> <string> <thread> <vector>)
endfunction()

# facewire_test(NAME SOURCES ... [DEPENDS ...] [LABELS ...]): one GoogleTest executable, one ctest entry.
function(facewire_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_compile_options(${name} PRIVATE ${FACEWIRE_TEST_OPTIONS})
  facewire_read_once(${name} REUSE_FROM facewire_test_headers)
  target_include_directories(${name} PRIVATE "${FACEWIRE_INCLUDE_ROOT_tests}")
  target_compile_definitions(${name} PRIVATE FACEWIRE_ASSETS="${FACEWIRE_ASSETS}"
                             FACEWIRE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS} GTest::gmock GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${FACEWIRE_TEST_TIMEOUT_S})
endfunction()

# facewire_benchmark(NAME SOURCES ... [DEPENDS ...]): one Google Benchmark executable, run by hand.
function(facewire_benchmark name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE "${FACEWIRE_INCLUDE_ROOT_tests}")
  target_compile_definitions(${name} PRIVATE FACEWIRE_ASSETS="${FACEWIRE_ASSETS}"
                             FACEWIRE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS} benchmark::benchmark_main)
endfunction()

# facewire_install_compressed(FILE NAME FOLDER): as FOLDER/NAME.gz, the way manual pages and changelogs are kept;
# the same bytes every time. Target documents makes all of them.
add_custom_target(documents ALL)
function(facewire_install_compressed file name folder)
  set(compressed "${CMAKE_CURRENT_BINARY_DIR}/${name}.gz")
  add_custom_command(OUTPUT "${compressed}" COMMAND gzip -9nc "${file}" > "${compressed}" DEPENDS "${file}" VERBATIM)
  add_custom_target(compress_${name} DEPENDS "${compressed}")
  add_dependencies(documents compress_${name})
  install(FILES "${compressed}" DESTINATION "${folder}")
endfunction()
