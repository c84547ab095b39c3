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
  luxel_eigen_layout(luxel_${name})
  luxel_compile_options(luxel_${name})
  install(TARGETS luxel_${name} EXPORT luxel ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/luxel DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()

# Warnings, instruction set and sanitizers for a target of our own.
function(luxel_compile_options target)
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

# Eigen aligns the arrays inside objects, and takes and gives back heap memory, by the instruction set that it is
# compiled for: a program without LUXEL_ARCHITECTURE would free what the libraries allocate in another way. 16 bytes is
# what all x86-64 agrees on; heap memory is taken Eigen's own way everywhere, which it is with AVX (v3, v4) already.
function(luxel_eigen_layout target)
  target_compile_definitions(${target} PUBLIC EIGEN_MAX_ALIGN_BYTES=16)
  if(LUXEL_ARCHITECTURE MATCHES "v[34]$" AND PROJECT_IS_TOP_LEVEL)
    target_compile_definitions(${target} INTERFACE $<INSTALL_INTERFACE:EIGEN_MALLOC_ALREADY_ALIGNED=0>)
  else()
    target_compile_definitions(${target} PUBLIC EIGEN_MALLOC_ALREADY_ALIGNED=0)
  endif()
endfunction()
