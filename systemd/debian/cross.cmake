# Read by cpack. Its own way to the packages that a program depends on asks this machine's dpkg.
set(SHLIBDEPS_EXECUTABLE "${CMAKE_CURRENT_LIST_DIR}/cross-shlibdeps")
