# Man pages from what the programs say of themselves (Debian: help2man), for those who have it.
find_program(HELP2MAN help2man)
if(NOT HELP2MAN OR ROEVO_SANITIZE OR ROEVO_FUZZ)
  return()
endif()
set(purpose_of_roevo-odometry "RGB-D visual odometry from organized edges")
set(purpose_of_roevo-render "pictures and 3-D views of maps and trajectories")
set(purpose_of_roevo-eval "errors of trajectories")
set(purpose_of_roevo-compare "comparison of RGB-D odometries on the same frames")
set(purpose_of_roevo-study "experiments with the odometry on any recording")
set(purpose_of_roevo-batch "many recordings and methods, on one machine or a cluster")
set(purpose_of_rgbd2rawlog "makes an MRPT rawlog of an RGB-D dataset or a bag")
set(purpose_of_rawlog2rgbd "makes an RGB-D dataset folder of an MRPT rawlog")
set(purpose_of_bag2rawlog "makes an MRPT rawlog of a ROS bag")
set(purpose_of_rawlog-simulate "simulates RGB-D recordings with exact ground truth")
foreach(program roevo-odometry roevo-render roevo-eval roevo-compare roevo-study roevo-batch rgbd2rawlog rawlog2rgbd
        bag2rawlog rawlog-simulate)
  set(page ${PROJECT_BINARY_DIR}/man/${program}.1)
  set(file ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/${program})  # roevo-batch is no target
  # help2man keeps lines apart that begin with a $
  add_custom_command(OUTPUT ${page} DEPENDS ${file} VERBATIM
                     COMMAND ${HELP2MAN} --no-info --name ${purpose_of_${program}} --source "ROEVO ${PROJECT_VERSION}"
                             --version-string ${PROJECT_VERSION} --help-option "--help | sed 's/^  ${program} /  $ &/; s/  $   /  $ /'"
                             --output ${page} ${file})
  list(APPEND man_pages ${page})
endforeach()
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/man)
add_custom_target(man ALL DEPENDS ${man_pages})
install(FILES ${man_pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)
