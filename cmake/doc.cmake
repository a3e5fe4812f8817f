# `cmake --build ... --target doc`: pages of the public headers by Doxygen, for those who have it; the method is their front.
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  return()
endif()
set(DOXYGEN_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/doc)
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE docs/method.md)
set(DOXYGEN_STRIP_FROM_INC_PATH libroevo/include libroevo/mrpt_module/include libroevo)
set(DOXYGEN_EXTRACT_ALL YES)
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_WARN_IF_UNDOCUMENTED NO)
set(DOXYGEN_WARN_NO_PARAMDOC NO)
set(DOXYGEN_WARN_IF_INCOMPLETE_DOC NO)  # of parameters only those are described that need it
get_target_property(recordings_headers roevo_recordings ROEVO_PUBLIC_HEADERS)
list(TRANSFORM recordings_headers PREPEND libroevo/recordings/)
doxygen_add_docs(doc docs datasets_readme libroevo/include libroevo/mrpt_module/include
                 ${recordings_headers} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
