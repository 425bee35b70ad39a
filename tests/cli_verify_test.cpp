// brdfit verify: what it prints, when it fails, and that it finds an error planted in the shader.
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

#include "io/material_json.h"
#include "tests/cli_fixture.h"
#include "tests/gpu_device.h"
#include "tests/json_schema.h"

namespace brdfit {
namespace {

using io::Json;
using testing::HasSubstr;
using testing::Not;
using tests::ProgramResult;

class CliVerify : public tests::CliFixture {
 protected:
  void SetUp() override {
    write("all", effects_of(Model::kCallisto));
    write("none", Effects());
  }

  void write(const std::string& name, Effects effects) {
    io::write_material(path(name + ".json"),
                       synthetic::random_material(Model::kCallisto, Tier::kFull, effects, {}, 3));
  }

  ProgramResult verify(const std::string& arguments) { return run("verify --pairs 20000 " + arguments); }

  Json verified(const std::string& arguments, int exit_code = 0) {
    const ProgramResult result = verify("--json " + arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    return Json::parse(result.out);
  }
};

TEST_F(CliVerify, FindsDeviceAndProcessorToAgreeWithNoMessageFromValidation) {
  const bool layers = tests::watched_request().on_validation_message != nullptr;
  const ProgramResult result = verify(std::string(layers ? "--validation " : "") + quoted("all.json"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, HasSubstr(tests::test_device().name()));
  EXPECT_THAT(result.out, HasSubstr("all 60000 values are within the threshold"));
}

TEST_F(CliVerify, PrintsJsonThatIsAsTheSchemaSays) {
  const tests::JsonSchema schema(
      io::read_json(std::filesystem::path(BRDFIT_SOURCE_DIR) / "docs/schema/verify.schema.json"));
  for (const char* options : {"", "--timings ", "--device 0 --seed 9 "}) {
    const Json json = verified(options + quoted("none.json"));
    EXPECT_EQ(schema.complaint(json), "") << json.dump(2);
  }
}

TEST_F(CliVerify, DrawsWhatBothDraw) {
  const std::string options = "--picture " + quoted("both.png") + " " + quoted("all.json");
  ASSERT_EQ(verify(options).exit_code, 0);
  EXPECT_GT(std::filesystem::file_size(path("both.png")), 10000U);
  EXPECT_EQ(verify(options).exit_code, 2);  // it is there already
  EXPECT_EQ(verify("--force " + options).exit_code, 0);
  EXPECT_EQ(verify("--picture both.exr " + quoted("all.json")).exit_code, 2);
}

TEST_F(CliVerify, FindsTheCorrectionsOfBakedAssetsToAgree) {
  const tests::JsonSchema schema(
      io::read_json(std::filesystem::path(BRDFIT_SOURCE_DIR) / "docs/schema/verify_realis.schema.json"));
  std::ofstream(path("dots.json")) << R"({"brdfit_stack_recipe": 1, "name": "dots", "width": 20, "height": 12,
      "materials": [{"brdfit": 1, "model": "lambert-ggx", "parameters": {"base_color": [0.5, 0.4, 0.3]}}],
      "lights": {"arrangement": "dome", "count": 20, "theta_deg": 60},
      "residual": {"lobes": 4, "sharpness": 4.0, "cut_off_deg": 180, "strength": 0.2}})";
  ASSERT_EQ(run("synth " + quoted("dots.json") + " -q -o " + quoted("stacks")).exit_code, 0);
  const std::string bake = "bake " + quoted("stacks/dots.olat.json") +
                           " -q --force --no-evidence --no-panels --base lambert --uniform --lobes 4 -o " +
                           quoted("baked");
  for (const char* options :
       {"", " --bits 4 --dominant 2", " --colour rgb --bits 4 --dominant 2", " --colour scaled-chroma"}) {
    ASSERT_EQ(run(bake + options).exit_code, 0) << options;
    const Json json = verified(quoted("baked/dots.realis.json"));
    EXPECT_EQ(schema.complaint(json), "") << json.dump(2);
    EXPECT_GT(json["largest_correction"].get<double>(), 0.02) << options;
  }
}

TEST_F(CliVerify, FindsAConstantThatWasChangedInTheShaderAlone) {
  for (const char* material : {"none.json", "all.json"}) {
    const std::string planted = std::string("--shader '" BRDFIT_PLANTED "' ") + quoted(material);
    const Json json = verified(planted, 4);
    EXPECT_FALSE(json["passed"]);
    EXPECT_GT(json["on_device"]["over"], 0);
    EXPECT_EQ(json["float_on_processor"]["over"], 0);
    EXPECT_THAT(verify(planted).out, HasSubstr("beyond the threshold"));
    EXPECT_EQ(verify("--shader '" BRDFIT_SHADER "' " + quoted(material)).exit_code, 0);
  }
}

TEST_F(CliVerify, ReproducesTheWorstPairByTheCommandThatItPrints) {
  const Json worst = verified(quoted("all.json"))["on_device"]["worst"];
  std::string command = worst["command"];
  ASSERT_EQ(command.rfind("brdfit ", 0), 0U) << command;
  const ProgramResult result = run(command.substr(7) + " --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json again = Json::parse(result.out);
  EXPECT_EQ(again["pairs"], 1);
  EXPECT_EQ(again["on_device"]["worst"]["wi"], worst["wi"]);
  EXPECT_EQ(again["on_device"]["worst"]["wo"], worst["wo"]);
  EXPECT_EQ(again["on_device"]["worst"]["value"], worst["value"]);
}

TEST_F(CliVerify, ListsTheDevices) {
  const ProgramResult result = run("verify --list-devices");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("0: "));
}

TEST_F(CliVerify, WithoutADriverFailsAndSaysWhatToInstall) {
  setenv("VK_DRIVER_FILES", "/nonexistent/driver.json", 1);
  const ProgramResult result = verify(quoted("all.json"));
  unsetenv("VK_DRIVER_FILES");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("mesa-vulkan-drivers"));
}

TEST_F(CliVerify, RefusesWhatMakesNoSense) {
  EXPECT_EQ(run("verify").exit_code, 2);
  EXPECT_EQ(run("verify --pairs 0 " + quoted("all.json")).exit_code, 2);
  EXPECT_EQ(run("verify --pair 0,0,2,0,0,1 " + quoted("all.json")).exit_code, 2);
  EXPECT_EQ(run("verify --pair 0,0,1 " + quoted("all.json")).exit_code, 2);
  EXPECT_EQ(run("verify " + quoted("missing.json")).exit_code, 3);
  write_bytes("text.spv", "not a shader");
  EXPECT_EQ(run("verify --shader " + quoted("text.spv") + " " + quoted("all.json")).exit_code, 3);
  EXPECT_EQ(run("verify --device nowhere " + quoted("all.json")).exit_code, 1);
}

// The shader as a driver sees it once model and effects are set, with the constants folded.
std::size_t instructions(const std::filesystem::path& folder, const std::string& constants,
                         const std::string& kind) {
  const std::string file = (folder / "specialised.spv").string();
  const std::string command =
      std::string(BRDFIT_SPIRV_OPT) + " --set-spec-const-default-value='" + constants +
      "' --freeze-spec-const --fold-spec-const-op-composite --ccp "
      "--eliminate-dead-branches --eliminate-dead-code-aggressive '" BRDFIT_SHADER "' -o '" +
      file + "' && spirv-dis '" + file + "' | grep -c ' " + kind + " ' > '" + file + ".count'";
  EXPECT_EQ(std::system(("(" + command + ") || [ $? = 1 ]").c_str()), 0);
  std::size_t count = 0;
  std::ifstream(file + ".count") >> count;
  return count;
}

TEST_F(CliVerify, HasNothingInThePipelineOfAnEffectThatIsOff) {
  const auto exponentials = [&](Effects effects) {
    return instructions(folder_.path(), "1:2 2:" + std::to_string(effects.bits()), "Exp");
  };
  EXPECT_EQ(exponentials(Effects()), 0U);
  EXPECT_EQ(exponentials(Effects().with(Effect::kDualSpecular)), 0U);
  EXPECT_EQ(exponentials(Effects().with(Effect::kRetroreflection)), 1U);
  EXPECT_EQ(exponentials(effects_of(Model::kCallisto)), 3U);
  EXPECT_EQ(instructions(folder_.path(), "1:2 2:0", "Log"), 0U);
}

}  // namespace
}  // namespace brdfit
