# viewer.html, the page that the tool fills: bundled by npm from viewer/ at build time. Without npm all else still works.
find_program(MATSTRUCT_NPM npm)
if(MATSTRUCT_BUILD_VIEWER AND NOT MATSTRUCT_NPM)
  message(WARNING "npm was not found: the viewer is not built, so that `view`, `render` and `compute --html` refuse to work")
elseif(MATSTRUCT_BUILD_VIEWER)
  set(viewer ${PROJECT_SOURCE_DIR}/viewer)
  set(workshop ${PROJECT_BINARY_DIR}/viewer)
  file(GLOB viewer_sources CONFIGURE_DEPENDS ${viewer}/src/* ${viewer}/*.mjs)
  add_custom_command(
    OUTPUT ${workshop}/installed
    COMMAND ${CMAKE_COMMAND} -E copy ${viewer}/package.json ${viewer}/package-lock.json ${workshop}
    COMMAND ${MATSTRUCT_NPM} ci --no-audit --no-fund --loglevel=error
    COMMAND ${CMAKE_COMMAND} -E touch ${workshop}/installed
    DEPENDS ${viewer}/package.json ${viewer}/package-lock.json
    WORKING_DIRECTORY ${workshop}
    COMMENT "Fetching the viewer's packages")
  add_custom_command(
    OUTPUT ${PROJECT_BINARY_DIR}/viewer.html
    COMMAND ${CMAKE_COMMAND} -E copy_directory ${viewer}/src ${workshop}/src
    COMMAND ${CMAKE_COMMAND} -E copy ${viewer}/build.mjs ${workshop}
    COMMAND node build.mjs ${PROJECT_BINARY_DIR}/viewer.html
    DEPENDS ${workshop}/installed ${viewer_sources}
    WORKING_DIRECTORY ${workshop}
    COMMENT "Bundling the viewer")
  file(MAKE_DIRECTORY ${workshop})
  add_custom_target(matstruct_viewer ALL DEPENDS ${PROJECT_BINARY_DIR}/viewer.html)
  add_dependencies(matstruct_tool matstruct_viewer)
  install(FILES ${PROJECT_BINARY_DIR}/viewer.html DESTINATION ${CMAKE_INSTALL_DATADIR}/matstruct)
endif()
