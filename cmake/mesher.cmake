# matstruct-mesher: the only program that links Gmsh and OpenCASCADE. Without them, tetrahedral input still works; without
# OpenCASCADE, surfaces too.
list(APPEND CMAKE_MODULE_PATH ${PROJECT_SOURCE_DIR}/cmake)
find_package(Gmsh)
find_package(OCCT)
set(MATSTRUCT_MESHER_FOLDER ${PROJECT_BINARY_DIR}/libexec)
if(Gmsh_FOUND)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/prepare/mesher/*.cpp)
  if(NOT OCCT_FOUND)
    list(FILTER sources EXCLUDE REGEX "/cad[^/]*\\.cpp$")
  endif()
  add_executable(matstruct_mesher ${sources})
  set_target_properties(matstruct_mesher PROPERTIES OUTPUT_NAME matstruct-mesher
                        RUNTIME_OUTPUT_DIRECTORY ${MATSTRUCT_MESHER_FOLDER})
  target_link_libraries(matstruct_mesher PRIVATE matstruct_flags Gmsh::Gmsh CGAL::CGAL)
  if(OCCT_FOUND)
    target_link_libraries(matstruct_mesher PRIVATE OCCT::OCCT)
    target_compile_definitions(matstruct_mesher PRIVATE MATSTRUCT_HAVE_OCCT)
  endif()
  # Never under a sanitizer: Gmsh leaks by design, and the limit of the process's address space leaves no room for shadow
  # memory.
  target_compile_options(matstruct_mesher PRIVATE -fno-sanitize=all)
  target_link_options(matstruct_mesher PRIVATE -fno-sanitize=all)
  install(TARGETS matstruct_mesher RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/matstruct)
  add_dependencies(matstruct_prepare matstruct_mesher)
endif()
target_compile_definitions(matstruct_prepare PRIVATE MATSTRUCT_MESHER_FOLDER="${MATSTRUCT_MESHER_FOLDER}")
target_link_libraries(matstruct_prepare PRIVATE ${CMAKE_DL_LIBS})
