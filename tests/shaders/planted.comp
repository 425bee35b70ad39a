// The material pass with an error: one of Proxima's and Lambert's constants is off in its fifth digit, in the
// shader alone.
#version 450
#extension GL_GOOGLE_include_directive : require

#include "brdf/kernel/math.h"
#undef BRDF_INV_PI
#define BRDF_INV_PI 0.31832

#include "gpu/shaders/material.glsl"
