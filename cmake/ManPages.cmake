# Manual pages of the C interface, from the comments of its header; left out where there is no Python to make them with.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_Interpreter_FOUND)
  set(man_folder ${CMAKE_BINARY_DIR}/share/man/man3)
  set(man_script ${CMAKE_SOURCE_DIR}/tools/make_man_pages.py)
  set(man_header ${CMAKE_SOURCE_DIR}/libopenrt/include/openrt/openrt.h)
  add_custom_command(OUTPUT ${man_folder}/openrt.3
                     COMMAND ${Python3_EXECUTABLE} ${man_script} ${man_header} ${man_folder} ${PROJECT_VERSION}
                     DEPENDS ${man_script} ${man_header}
                     COMMENT "Manual pages: openrt.h -> share/man/man3")
  add_custom_target(man_pages ALL DEPENDS ${man_folder}/openrt.3)
  install(DIRECTORY ${man_folder}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man3 FILES_MATCHING PATTERN "*.3")
endif()
