# matstruct-mesher: the only program that links Gmsh. Without Gmsh, tetrahedral input still works.
list(APPEND CMAKE_MODULE_PATH ${PROJECT_SOURCE_DIR}/cmake)
find_package(Gmsh)
set(MATSTRUCT_MESHER_FOLDER ${PROJECT_BINARY_DIR}/libexec)
if(Gmsh_FOUND)
  add_executable(matstruct_mesher src/prepare/mesher/main.cpp)
  set_target_properties(matstruct_mesher PROPERTIES OUTPUT_NAME matstruct-mesher
                        RUNTIME_OUTPUT_DIRECTORY ${MATSTRUCT_MESHER_FOLDER})
  target_link_libraries(matstruct_mesher PRIVATE matstruct_flags Gmsh::Gmsh)
  # Never under a sanitizer: Gmsh leaks by design, and the limit of the process's address space leaves no room for shadow
  # memory.
  target_compile_options(matstruct_mesher PRIVATE -fno-sanitize=all)
  target_link_options(matstruct_mesher PRIVATE -fno-sanitize=all)
  install(TARGETS matstruct_mesher RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/matstruct)
  add_dependencies(matstruct_prepare matstruct_mesher)
endif()
target_compile_definitions(matstruct_prepare PRIVATE MATSTRUCT_MESHER_FOLDER="${MATSTRUCT_MESHER_FOLDER}")
target_link_libraries(matstruct_prepare PRIVATE ${CMAKE_DL_LIBS})
