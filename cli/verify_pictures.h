// What the device draws beside what the processor draws: for people.
#ifndef BRDFIT_CLI_VERIFY_PICTURES_H_
#define BRDFIT_CLI_VERIFY_PICTURES_H_

#include <string>

#include "brdf/material.h"
#include "gpu/material_pass.h"
#include "render/image.h"

namespace brdfit::cli {

// A slice at phi_d = 90 deg and spheres under three lights, each as the processor draws it in double, as the
// device does, and their difference a thousand times as strong.
render::Picture verify_panel(const Material& material, const std::string& name, const std::string& device,
                             MaterialPass& pass);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_VERIFY_PICTURES_H_
