// Light stacks with known answers: a recipe in, photographs of a surface under each light out.
#ifndef BRDFIT_DATA_SYNTHETIC_STACK_H_
#define BRDFIT_DATA_SYNTHETIC_STACK_H_

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "brdf/realis.h"
#include "data/synthetic/stack_recipe.h"
#include "measured/image_stack.h"

namespace brdfit::synthetic {

// A stack that is computed where it is read. Values depend on the recipe alone, never on threads or on the
// order of reading. info() is what the manifest says, faults included; true_lights() are the lights that lit
// the surface. rgb of masked texels (beside a sphere) is 0 and their weight 0.
class SyntheticStack : public ImageStack {
 public:
  // Throws std::invalid_argument if the recipe is not valid.
  explicit SyntheticStack(StackRecipe recipe);
  ~SyntheticStack() override;

  const StackInfo& info() const override { return info_; }
  TexelBlock read_rows(int first_row, int rows) override;
  TexelBlock read_texels(std::span<const std::uint32_t> texels) override;

  // One light's values for some texels (ascending), [channel][texel].
  std::vector<float> picture(std::size_t light, std::span<const std::uint32_t> texels) const;

  const std::vector<StackLight>& true_lights() const { return true_lights_; }
  const LobeSet& lobes() const { return lobes_; }
  bool is_masked(std::uint32_t texel) const;
  Vec3 normal(std::uint32_t texel) const;
  // Base colour; what the manifest's albedo holds.
  Rgb albedo(std::uint32_t texel) const;
  // Of a lobe of the residual, in units of pi f.
  double amplitude(std::uint32_t texel, std::size_t lobe) const;
  // Whether something stands between the texel and the light.
  bool in_cast_shadow(std::uint32_t texel, const Vec3& direction) const;

 private:
  struct Surface;
  // Places in a chunk of texels, and the direction towards the light at each texel of the chunk.
  struct Run {
    std::vector<std::size_t> places;
    std::vector<Vec3> towards;
  };
  void reflect(std::size_t material, const Run& run, std::span<const std::uint32_t> texels,
               std::span<Rgb> reflected) const;
  // Without noise and faults.
  std::vector<Rgb> radiance(const StackInfo& truth, std::size_t light,
                            std::span<const std::uint32_t> texels) const;
  double residual(std::uint32_t texel, const Vec3& direction) const;
  double noisy(double value, std::size_t light, std::uint32_t texel, std::size_t channel) const;
  void add_hot_pixels(std::size_t light, std::span<const std::uint32_t> texels,
                      std::span<float> picture) const;
  std::size_t material_of(std::uint32_t texel) const;
  double shade_of_albedo(std::uint32_t texel) const;

  StackRecipe recipe_;
  StackInfo info_;
  std::vector<StackLight> true_lights_;
  LobeSet lobes_;
  std::unique_ptr<Surface> surface_;
};

}  // namespace brdfit::synthetic

#endif  // BRDFIT_DATA_SYNTHETIC_STACK_H_
