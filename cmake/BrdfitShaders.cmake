# GLSL through glslc and spirv-val.

find_program(BRDFIT_GLSLC glslc)
if(NOT BRDFIT_GLSLC)
  message(FATAL_ERROR "glslc was not found. On Debian: apt-get install glslc (or run scripts/setup)")
endif()
find_program(BRDFIT_SPIRV_VAL spirv-val)
if(NOT BRDFIT_SPIRV_VAL)
  message(FATAL_ERROR "spirv-val was not found. On Debian: apt-get install spirv-tools (or run scripts/setup)")
endif()

# brdfit_compile_shader(SOURCE OUTPUT): SPIR-V for Vulkan 1.1, validated; a warning is an error.
function(brdfit_compile_shader source output)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${BRDFIT_GLSLC} -Werror --target-env=vulkan1.1 -O -I ${CMAKE_SOURCE_DIR} -MD -MF ${output}.d
            -fshader-stage=compute ${source} -o ${output}
    COMMAND ${BRDFIT_SPIRV_VAL} --target-env vulkan1.1 ${output}
    DEPENDS ${source}
    DEPFILE ${output}.d
    COMMENT "glslc + spirv-val ${output}"
    VERBATIM)
endfunction()
