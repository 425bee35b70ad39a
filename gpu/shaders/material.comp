// The material pass; what it does is in material.glsl.
#version 450
#extension GL_GOOGLE_include_directive : require

#include "gpu/shaders/material.glsl"
