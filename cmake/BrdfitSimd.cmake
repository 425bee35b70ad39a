# Vector code with run-time dispatch: a source is compiled once for every instruction set, each time in a namespace
# of its own (BRDFIT_SIMD_ISA), and the best one that the machine has is chosen when the program runs.
#
# Such a source includes only brdf/simd/lanes.h and kernel headers, and uses kernels with lanes alone: any inline
# function shared with the rest of the program could be the copy that the linker keeps.

if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|amd64")
  set(BRDFIT_SIMD_ISAS baseline avx2 avx512)
else()
  set(BRDFIT_SIMD_ISAS baseline)
endif()
set(BRDFIT_SIMD_FLAGS_baseline "")
set(BRDFIT_SIMD_FLAGS_avx2 -mavx2 -mfma -mf16c -mbmi -mbmi2 -mpclmul -maes)
set(BRDFIT_SIMD_FLAGS_avx512 ${BRDFIT_SIMD_FLAGS_avx2} -mavx512f -mavx512vl -mavx512dq -mavx512bw -mavx512cd)

# Instrumented at -O3 a source of vector code takes minutes to compile, for each instruction set. So the address
# sanitizer watches one of them, the widest, and the others are compiled without.
list(GET BRDFIT_SIMD_ISAS -1 widest)
foreach(isa IN LISTS BRDFIT_SIMD_ISAS)
  set(BRDFIT_SIMD_OPTIMISE_${isa} -O3)
  if(BRDFIT_SANITIZE AND isa STREQUAL widest)
    set(BRDFIT_SIMD_OPTIMISE_${isa} -O1 -fsanitize=address -fno-omit-frame-pointer)
  endif()
endforeach()

# brdfit_add_simd(TARGET SOURCE...): adds the sources to the target, once for every instruction set.
function(brdfit_add_simd target)
  foreach(isa IN LISTS BRDFIT_SIMD_ISAS)
    set(objects ${target}_simd_${isa})
    add_library(${objects} OBJECT ${ARGN})
    target_include_directories(${objects} PRIVATE ${CMAKE_SOURCE_DIR})
    target_compile_definitions(${objects} PRIVATE BRDFIT_SIMD_ISA=${isa})
    target_link_libraries(${objects} PRIVATE brdfit_warnings PkgConfig::hwy)
    # -Wno-psabi: vectors are passed by value between functions of one instruction set only.
    target_compile_options(${objects} PRIVATE ${BRDFIT_SIMD_FLAGS_${isa}} ${BRDFIT_SIMD_OPTIMISE_${isa}} -ffp-contract=fast
                                              -Wno-psabi)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
  endforeach()
  if("avx512" IN_LIST BRDFIT_SIMD_ISAS)
    target_compile_definitions(${target} PUBLIC BRDFIT_HAVE_X86_ISAS)
  endif()
endfunction()
