// Material JSON.
#include "io/material_json.h"
#include "tests/fuzz/harness.h"

namespace brdfit::fuzz {

bool run_material(Bytes input) {
  const auto check = [](const Material& material) {
    std::string why;
    require(material.is_valid(&why), "a material that is read is valid: " + why);
  };
  return run_json(input, io::read_material, check, [](const auto& file, const Material& material) {
    io::write_material(file, material, nullptr);
  });
}

}  // namespace brdfit::fuzz
