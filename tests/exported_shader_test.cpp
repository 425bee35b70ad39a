// Exported shaders, compiled by the command that they name and run on a device, against the CPU.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "brdf/models.h"
#include "brdf/shader/material_shader.h"
#include "tests/gpu_device.h"
#include "tests/random_parameters.h"
#include "tests/temp_folder.h"

namespace brdfit {
namespace {

using shader::Language;
using testing_support::Random;
using testing_support::uniform;

// The command on the shader's fourth line, with the file in place of FILE.
std::string compile_command(const std::string& shader, const std::string& file) {
  std::istringstream lines(shader);
  std::string line;
  for (int k = 0; k < 4; ++k) std::getline(lines, line);
  const std::size_t begin = line.find("glslc ");
  const std::size_t at = line.find(" FILE");
  if (begin == std::string::npos || at == std::string::npos) return "false";
  return BRDFIT_GLSLC + line.substr(begin + 5, at - begin - 5) + " '" + file + "' -o '" + file + ".spv'";
}

class ExportedShader : public testing::Test {
 protected:
  std::vector<std::uint32_t> compiled(const Material& material, const shader::ShaderOptions& options) {
    const std::string text = shader::material_shader(material, options);
    const std::string file = (folder_.path() / "material.shader").string();
    std::ofstream(file) << text;
    EXPECT_EQ(std::system(compile_command(text, file).c_str()), 0) << text;
    std::ifstream spirv(file + ".spv", std::ios::binary);
    std::stringstream bytes;
    bytes << spirv.rdbuf();
    const std::string all = bytes.str();
    std::vector<std::uint32_t> words(all.size() / 4);
    std::memcpy(words.data(), all.data(), words.size() * 4);
    return words;
  }

  void expect_same_as_cpu(const Material& material, const shader::ShaderOptions& options) {
    Random random(5);
    std::vector<float> pairs;
    for (int k = 0; k < 500; ++k) {
      for (int direction = 0; direction < 2; ++direction) {
        const double z = uniform(random, 0.05, 1.0);
        const double phi = uniform(random, 0.0, 2.0 * std::numbers::pi);
        const double s = std::sqrt(1.0 - z * z);
        for (const double x : {s * std::cos(phi), s * std::sin(phi), z, 0.0})
          pairs.push_back(static_cast<float>(x));
      }
    }
    std::vector<float> found(pairs.size() / 2);
    run_shader(tests::test_device(), compiled(material, options), pairs, found);
    for (std::size_t k = 0; k < found.size() / 4; ++k) {
      const float* p = pairs.data() + 8 * k;
      const Rgb expected = eval_cos(material, {p[0], p[1], p[2]}, {p[4], p[5], p[6]});
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(found[4 * k + c], expected[c], 1e-6 + 5e-5 * std::abs(expected[c])) << k;
      }
    }
  }

  tests::TempFolder folder_;
};

TEST_F(ExportedShader, GivesTheNumbersOfTheCpu) {
  Random random(3);
  for (const Model model : all_models()) {
    for (const Effects effects : {Effects(), effects_of(model)}) {
      for (const Language language : {Language::kGlsl, Language::kHlsl}) {
        for (const bool baked : {true, false}) {
          Material material = testing_support::random_material(model, effects, random);
          // Parameters are floats in the shader.
          for (double& value : material.values()) value = static_cast<float>(value);
          material.set("roughness", std::max(material.number("roughness"), 0.25));
          shader::ShaderOptions options;
          options.language = language;
          options.baked = baked;
          expect_same_as_cpu(material, options);
        }
      }
    }
  }
}

TEST_F(ExportedShader, GivesTheNumbersOfEachEffectAndOption) {
  Random random(4);
  for (const Effect effect : all_effects()) {
    const bool is_callisto = effects_of(Model::kCallisto).has(effect);
    const Model model = is_callisto ? Model::kCallisto : Model::kBurley;
    Material material = testing_support::random_material(model, Effects().with(effect), random);
    for (double& value : material.values()) value = static_cast<float>(value);
    material.set("roughness", 0.5);
    material.options() = {Masking::kCorrelated, BurleyG::k2017, Diffuse::kProxima};
    expect_same_as_cpu(material, {});
  }
}

}  // namespace
}  // namespace brdfit
