# luxel_module(NAME [PUBLIC target...] [PRIVATE target...])
#
# A folder of the house as one static library: sources in src/, public headers in include/, everything else private.
# The target is luxel_NAME, the name for users luxel::NAME. An include against the direction of dependencies does not
# compile, because only the PUBLIC targets' include roots are seen.
function(luxel_module name)
  cmake_parse_arguments(MODULE "" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/*.cpp)
  add_library(luxel_${name} STATIC ${sources})
  add_library(luxel::${name} ALIAS luxel_${name})
  set_target_properties(luxel_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(luxel_${name} PUBLIC cxx_std_20)
  target_include_directories(luxel_${name}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_link_libraries(luxel_${name} PUBLIC ${MODULE_PUBLIC} PRIVATE ${MODULE_PRIVATE})
  target_compile_definitions(luxel_${name} INTERFACE ${luxel_eigen_layout})
  luxel_compile_options(luxel_${name})
  install(TARGETS luxel_${name} EXPORT luxel ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/luxel DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()

# Eigen lays out, allocates and frees its arrays by the instruction set that it is compiled for; a program built without
# LUXEL_ARCHITECTURE would free what these libraries allocate in another way. 16 is what all x86-64 agrees on. Every
# target of ours and every user of one has it: one without is enough to mix the two.
set(luxel_eigen_layout EIGEN_MAX_ALIGN_BYTES=16 EIGEN_MALLOC_ALREADY_ALIGNED=1)

# Warnings, instruction set and sanitizers for a target of our own.
function(luxel_compile_options target)
  target_compile_definitions(${target} PRIVATE ${luxel_eigen_layout})
  # maybe-uninitialized: gcc 12 reports every std::optional and fixed Eigen array that it inlines (gcc bug 80635)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wno-psabi -Wno-maybe-uninitialized)
  if(LUXEL_ARCHITECTURE)
    target_compile_options(${target} PRIVATE -march=${LUXEL_ARCHITECTURE})
  endif()
  if(LUXEL_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${LUXEL_SANITIZE} -fno-sanitize-recover=all
                                             -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${LUXEL_SANITIZE})
  endif()
endfunction()
