// Relighting from the outside: lights from every side, and surfaces that are not the ones that were baked.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "io/exr_rows.h"
#include "tests/cli_stack_fixture.h"
#include "tests/stack_files.h"

namespace brdfit::cli {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 24;
constexpr int kHeight = 80;  // more rows than are relit at once
constexpr std::size_t kTexels = static_cast<std::size_t>(kWidth) * kHeight;

class CliRelight : public tests::CliStackFixture {
 protected:
  // Baked once.
  void SetUp() override {
    synth(matte_bumps(kWidth, kHeight, 20));
    const tests::ProgramResult baked =
        run("bake -q --lobes 4 --base lambert --no-evidence --fade-albedo 0.2 --fade-normal 20 -o " +
            quoted("baked") + " " + quoted("stack/bumps.olat.json"));
    ASSERT_EQ(baked.exit_code, 0) << baked.err;
  }

  tests::ProgramResult relight(const std::string& options, const std::string& file = "relit.exr") {
    return run("relight -q --force -o " + quoted(file) + " " + options + " " +
               quoted("baked/bumps.realis.json"));
  }
  std::string bytes(const std::string& options, const std::string& file = "relit.exr") {
    const tests::ProgramResult relit = relight(options, file);
    EXPECT_EQ(relit.exit_code, 0) << options << relit.err;
    return tests::read_text(path(file));
  }
  std::vector<float> values(const std::string& options) {
    bytes(options);
    return io::ExrRowReader(path("relit.exr"), {"R", "G", "B"}).read(0, kHeight);
  }

  // The surface as it was baked: albedo (first three) and normals, [6][texel].
  std::vector<float> baked_surface() const {
    return io::ExrRowReader(path("baked/bumps.surface.exr"),
                            {"albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z"})
        .read(0, kHeight);
  }
  // A picture of three of its planes, changed.
  std::string picture(const std::string& name, std::size_t first_plane,
                      const std::function<float(float value, std::size_t texel, int c)>& change) {
    const std::vector<float> surface = baked_surface();
    tests::write_picture(path(name), kWidth, kHeight, 3, io::SampleType::kFloat, [&](int x, int y, int c) {
      const std::size_t texel = static_cast<std::size_t>(y * kWidth + x);
      return change(surface[(first_plane + static_cast<std::size_t>(c)) * kTexels + texel], texel, c);
    });
    return quoted(name);
  }
  std::string albedo(const std::string& name, float offset) {
    return " --albedo " + picture(name, 0, [offset](float v, std::size_t, int) { return v + offset; });
  }
  // Normals turned about the y axis.
  std::string normals(const std::string& name, double degrees) {
    const std::vector<float> surface = baked_surface();
    const double angle = degrees * std::acos(-1.0) / 180.0;
    return " --normals " + picture(name, 3, [&, angle](float v, std::size_t texel, int c) {
             const double x = static_cast<double>(surface[3 * kTexels + texel]);
             const double z = static_cast<double>(surface[5 * kTexels + texel]);
             if (c == 1) return v;
             return static_cast<float>(c == 0 ? std::cos(angle) * x + std::sin(angle) * z
                                              : std::cos(angle) * z - std::sin(angle) * x);
           });
  }
  // Root of the mean squared size of what the correction adds to the render of the same surface.
  double correction(const std::string& options) {
    const std::vector<float> corrected = values(options);
    const std::vector<float> render = values(options + " --base");
    double squares = 0.0;
    for (std::size_t k = 0; k < render.size(); ++k) {
      squares += std::pow(static_cast<double>(corrected[k] - render[k]), 2);
    }
    return std::sqrt(squares / static_cast<double>(render.size()));
  }

  const std::string light_ = "--light 0.3,0.4,0.8";
};

TEST_F(CliRelight, TakesNegativeNumbersFirst) {
  const std::string left = bytes("--light=-0.5,0.3,0.8");
  EXPECT_EQ(bytes("--light -0.5,0.3,0.8"), left);
  EXPECT_EQ(bytes("--light -.5,.3,.8"), left);
  EXPECT_EQ(bytes("--light -0.5 0.3 0.8"), left);
  EXPECT_EQ(bytes("--light -5e-1,0.3,0.8"), left);
  EXPECT_NE(bytes("--light 0.5,0.3,0.8"), left);
  EXPECT_NE(bytes("--light -0.5,-0.3,0.8"), left);
  EXPECT_NE(bytes("--exposure -1", "relit.png"), bytes("", "relit.png"));
}

TEST_F(CliRelight, RefusesWhatIsNoLight) {
  for (const std::string& options :
       {std::string("--light -1,0"), std::string("--light 0,0,0"), std::string("--light nan,0,1"),
        std::string("--intensity -1,1,1"), std::string("--intensity 1,inf,1"),
        std::string("--albedo-scale 1,-1,1")}) {
    const tests::ProgramResult result = relight(options);
    EXPECT_EQ(result.exit_code, 2) << options;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr(options.substr(0, options.find(' '))));
  }
}

TEST_F(CliRelight, AnUnchangedSurfaceChangesNoByte) {
  const std::string plain = bytes(light_);
  EXPECT_EQ(bytes(light_ + albedo("a.exr", 0.0F) + normals("n.exr", 0.0)), plain);
  EXPECT_EQ(bytes(light_ + " --albedo-scale 1,1,1"), plain);
}

TEST_F(CliRelight, TheAssetsOwnThinPropertiesAreNearlyTheSame) {
  const std::vector<float> plain = values(light_);
  const std::vector<float> thin = values(light_ + " --albedo " + quoted("baked/bumps.albedo.png") +
                                         " --normals " + quoted("baked/bumps.normals.png"));
  for (std::size_t k = 0; k < plain.size(); ++k) EXPECT_NEAR(thin[k], plain[k], 0.02F);
}

TEST_F(CliRelight, BeyondTheFadeTheRenderIsLeft) {
  const std::string plain = bytes(light_ + " --base");
  for (const std::string& surface : {albedo("a1.exr", 0.2F), normals("n2.exr", 25.0),
                                     albedo("a3.exr", 0.05F) + normals("n3.exr", -30.0)}) {
    const std::string found = bytes(light_ + surface);
    EXPECT_TRUE(found == bytes(light_ + surface + " --base")) << surface;
    EXPECT_TRUE(found != plain) << "the render is of the new surface";
  }
}

TEST_F(CliRelight, BetweenTheCorrectionFadesSteadily) {
  const double whole = correction(light_);
  EXPECT_GT(whole, 0.01);
  double last = whole;
  for (const float offset : {0.04F, 0.1F}) {
    const double left = correction(light_ + albedo("a.exr", offset));
    EXPECT_LT(left, last);
    // The distance of albedos is that of points: three channels moved alike.
    EXPECT_NEAR(left, whole * (1.0 - static_cast<double>(offset) * std::sqrt(3.0) / 0.2), 1e-5);
    last = left;
  }
  last = correction(light_ + normals("n.exr", 0.0));
  for (const double degrees : {6.0, 17.0}) {
    // Towards the light, where n.l grows: what is lost is lost to the fade.
    const double left = correction(light_ + normals("n.exr", degrees));
    EXPECT_LT(left, last) << degrees;
    EXPECT_GT(left, 0.0);
    last = left;
  }
}

TEST_F(CliRelight, AScaledAlbedoIsThatPicture) {
  const std::string scaled = picture("a.exr", 0, [](float v, std::size_t, int c) {
    return static_cast<float>((c == 0 ? 0.9 : 1.1) * static_cast<double>(v));
  });
  EXPECT_EQ(bytes(light_ + " --albedo-scale 0.9,1.1,1.1"), bytes(light_ + " --albedo " + scaled));
}

TEST_F(CliRelight, HolesAndNormalsThatFaceAwayStayFinite) {
  const std::string holes = picture("n.exr", 3, [](float v, std::size_t texel, int) {
    if (texel < 100) return 0.0F;
    return texel < 200 ? std::numeric_limits<float>::quiet_NaN() : texel < 300 ? -v : v;
  });
  const std::vector<float> plain = values(light_);
  const std::vector<float> found = values(light_ + " --normals " + holes);
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_TRUE(std::isfinite(found[k]));
    const std::size_t texel = k % kTexels;
    if (texel < 200 || texel >= 300) {
      EXPECT_EQ(found[k], plain[k]) << "the baked normal stays where there is none";
    } else {
      EXPECT_EQ(found[k], 0.0F) << "unlit";
    }
  }
}

TEST_F(CliRelight, NamesWhatIsWrongWithASurface) {
  tests::write_grey(path("small.png"), 7, 5);
  write_bytes("text.png", "no picture");
  tests::write_picture(path("negative.exr"), kWidth, kHeight, 3, io::SampleType::kFloat,
                       [](int x, int y, int) { return x == 2 && y == 70 ? -0.5F : 0.5F; });
  const std::vector<std::pair<std::string, std::string>> mistakes = {
      {"--albedo " + quoted("none.png"), "none.png"},
      {"--normals " + quoted("text.png"), "text.png"},
      {"--albedo " + quoted("small.png"), "is 7 x 5 pixels (expected 24 x 80 as bumps.realis.json)"},
      {"--normals " + quoted("small.png"), "is 7 x 5 pixels (expected 24 x 80 as bumps.realis.json)"},
      {"--albedo " + quoted("negative.exr"), "pixel (2, 70) holds -0.5 (expected an albedo of 0 or more)"}};
  for (const auto& [options, part] : mistakes) {
    const tests::ProgramResult result = relight(options, "bad.exr");
    EXPECT_EQ(result.exit_code, 3) << options;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr(part));
    EXPECT_FALSE(std::filesystem::exists(path("bad.exr")));
  }
}

}  // namespace
}  // namespace brdfit::cli
