# Finding packages, with the Debian package to install named where one is missing.

# brdfit_require(NAME DEBIAN_PACKAGE [MIN_VERSION])
# brdfit_require(NAME DEBIAN_PACKAGE PKG_CONFIG MODULE): through pkg-config, as the target PkgConfig::NAME.
function(brdfit_require name package)
  if(ARGV2 STREQUAL "PKG_CONFIG")
    find_package(PkgConfig QUIET)
    if(NOT PkgConfig_FOUND)
      message(FATAL_ERROR "pkg-config was not found. On Debian: apt-get install pkg-config")
    endif()
    pkg_check_modules(${name} IMPORTED_TARGET GLOBAL QUIET ${ARGV3})
  else()
    find_package(${name} ${ARGV2} QUIET GLOBAL)
  endif()
  if(NOT ${name}_FOUND)
    message(FATAL_ERROR "${name} ${ARGV2} was not found. On Debian: apt-get install ${package} (or run scripts/setup)")
  endif()
endfunction()
