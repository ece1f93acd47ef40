# One static library per layer of src/, so that a layer that reaches upwards does not link.

set(MATSTRUCT_WARNINGS -Wall -Wextra -Wshadow -Wconversion -Wsign-conversion)
if(MATSTRUCT_WERROR)
  list(APPEND MATSTRUCT_WARNINGS -Werror)
endif()

# Flags of every target: the same floating-point results with every compiler and thread count, and all warnings.
add_library(matstruct_flags INTERFACE)
target_compile_options(matstruct_flags INTERFACE $<BUILD_INTERFACE:-ffp-contract=off> $<BUILD_INTERFACE:${MATSTRUCT_WARNINGS}>)
target_compile_features(matstruct_flags INTERFACE cxx_std_20)
target_include_directories(matstruct_flags INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
  $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

# matstruct_layer(name [USES layer...] [PUBLIC_LIBRARIES lib...] [PRIVATE_LIBRARIES lib...])
function(matstruct_layer name)
  cmake_parse_arguments(ARG "" "" "USES;PUBLIC_LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  set(target matstruct_${name})
  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE ${ARG_PRIVATE_LIBRARIES})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  set_property(GLOBAL APPEND PROPERTY MATSTRUCT_LAYER_TARGETS ${target})
  target_link_libraries(${target} ${scope} matstruct_flags ${ARG_PUBLIC_LIBRARIES})
  foreach(used ${ARG_USES})
    target_link_libraries(${target} ${scope} matstruct_${used})
  endforeach()
endfunction()

# The one library that users link: `matstruct::matstruct`.
function(matstruct_library)
  add_library(matstruct INTERFACE)
  add_library(matstruct::matstruct ALIAS matstruct)
  target_link_libraries(matstruct INTERFACE matstruct_pipeline matstruct_reconstruct)
endfunction()
