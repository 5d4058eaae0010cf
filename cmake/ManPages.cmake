# Builds manual pages of the C interface from the comments of its headers, and the other
# documentation of the programs. Without Python, the pages and completions are left out.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_Interpreter_FOUND)
  set(man_folder ${CMAKE_BINARY_DIR}/share/man/man3)
  set(man_script ${CMAKE_SOURCE_DIR}/tools/make_man_pages.py)
  set(man_headers ${OPENRT_API_HEADERS})
  add_custom_command(OUTPUT ${man_folder}/openrt.3
                     COMMAND ${Python3_EXECUTABLE} ${man_script} ${man_folder} ${PROJECT_VERSION} ${man_headers}
                     DEPENDS ${man_script} ${man_headers}
                     COMMENT "Manual pages: openrt/*.h -> share/man/man3")
  add_custom_target(man_pages ALL DEPENDS ${man_folder}/openrt.3)
  install(DIRECTORY ${man_folder}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man3 FILES_MATCHING PATTERN "*.3")
endif()

# Manual pages and completions of the programs, generated from their --help. A cross build needs an
# emulator that runs the programs, and has none of these files without one.
if(Python3_Interpreter_FOUND AND (NOT CMAKE_CROSSCOMPILING OR CMAKE_CROSSCOMPILING_EMULATOR))
  string(REPLACE ";" "|" emulator "${CMAKE_CROSSCOMPILING_EMULATOR}")
  set(docs_script ${CMAKE_SOURCE_DIR}/tools/make_program_docs.py)
  set(documented vv openrt-replay nodegen)
  if(TARGET openrt-worker)
    list(APPEND documented openrt-worker)
  endif()
  list(TRANSFORM documented REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE documented_programs)
  add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/share/man/man1/vv.1
                     COMMAND ${CMAKE_COMMAND} -E env "EMULATOR=${emulator}"
                             ${Python3_EXECUTABLE} ${docs_script} ${PROJECT_VERSION} ${CMAKE_BINARY_DIR}/share ${documented_programs}
                     DEPENDS ${docs_script} ${documented}
                     COMMENT "Manual pages and completions: --help -> share" VERBATIM)
  add_custom_target(program_docs ALL DEPENDS ${CMAKE_BINARY_DIR}/share/man/man1/vv.1)
  foreach(program ${documented})
    if(program STREQUAL nodegen)
      set(component dev)
    else()
      set(component vv)
    endif()
    install(FILES ${CMAKE_BINARY_DIR}/share/man/man1/${program}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
    install(FILES ${CMAKE_BINARY_DIR}/share/bash-completion/completions/${program}
            DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT ${component})
    install(FILES ${CMAKE_BINARY_DIR}/share/zsh/site-functions/_${program}
            DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT ${component})
    install(FILES ${CMAKE_BINARY_DIR}/share/fish/vendor_completions.d/${program}.fish
            DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT ${component})
  endforeach()
endif()

# The desktop menu entry, the file types that vv opens, and its icon.
if(NOT OPENRT_WHEEL)
  set(desktop ${CMAKE_SOURCE_DIR}/apps/vv/desktop)
  install(FILES ${desktop}/vv.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT vv)
  install(FILES ${desktop}/vv.thumbnailer DESTINATION ${CMAKE_INSTALL_DATADIR}/thumbnailers COMPONENT vv)
  install(FILES ${desktop}/openrt-vv.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT vv)
  install(FILES ${desktop}/vv.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo RENAME org.openrt.vv.metainfo.xml COMPONENT vv)
  foreach(size 48 128 256)
    install(FILES ${desktop}/icon-${size}.png DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/${size}x${size}/apps
            RENAME vv.png COMPONENT vv)
  endforeach()
endif()
