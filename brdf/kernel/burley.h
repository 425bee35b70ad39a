// Burley's principled model of 2012 ("Disney"), reflection only (Burley 2012, sections 5.3-5.6, appendix of
// the course notes; subsurface after Hanrahan and Krueger 1993).
//
// Steps (shape, terms, colour): lambert_ggx.h. Masking V has two forms: `2012` remaps roughness for V only,
// `2017` uses the alpha of the distribution.
#ifndef BRDFIT_BRDF_KERNEL_BURLEY_H_
#define BRDFIT_BRDF_KERNEL_BURLEY_H_

#include "fresnel.h"
#include "ggx.h"

#define BRDF_BURLEY_G_2012 0
#define BRDF_BURLEY_G_2017 1

// Bits of `effects`.
#define BRDF_EFFECT_SUBSURFACE 32
#define BRDF_EFFECT_SPECULAR_TINT 64
#define BRDF_EFFECT_ANISOTROPIC 128
#define BRDF_EFFECT_SHEEN 256
#define BRDF_EFFECT_CLEARCOAT 512

BRDF_NAMESPACE_BEGIN

BRDF_REAL_STRUCT(BurleyShape) {
  Real roughness;
  Real subsurface;
  Real alpha_x;  // = alpha_y where isotropic
  Real alpha_y;
  Real clearcoat_alpha;
};

BRDF_REAL_STRUCT(BurleyColour) {
  Real rho;    // diffuse albedo, base_color (1 - metallic)
  Real sheen;  // sheen colour (1 - metallic)
  Real f0;
  Real clearcoat;
};

BRDF_REAL_STRUCT(BurleyTerms) {
  Real diffuse;    // f cos_i per unit rho
  Real sheen;      // F_H cos_i
  Real falloff;    // F_H
  Real specular;   // D V cos_i
  Real clearcoat;  // 0.25 D_c F_c V_c cos_i
};

// What cos_i and cos_o do not change; see lambert_ggx.h.
BRDF_REAL_STRUCT(BurleyLine) {
  Real falloff;
  Real d;            // D of the specular lobe
  Real clearcoat_d;  // D_c
  Real clearcoat_f;  // 0.25 F_c
};

BRDF_REAL_FUNCTION
OF_REAL(BurleyShape)
burley_shape(Real roughness, Real subsurface, Real anisotropic, Real clearcoat_gloss, int effects) {
  OF_REAL(BurleyShape) shape;
  shape.roughness = roughness;
  shape.subsurface = subsurface;
  shape.alpha_x = roughness * roughness;
  shape.alpha_y = roughness * roughness;
  if ((effects & BRDF_EFFECT_ANISOTROPIC) != 0) {
    Real aspect = sqrt(REAL(1.0) - REAL(0.9) * anisotropic);
    shape.alpha_x = at_least(roughness * roughness / aspect, REAL(0.001));
    shape.alpha_y = at_least(roughness * roughness * aspect, REAL(0.001));
  }
  shape.clearcoat_alpha = lerp_real(REAL(0.1), REAL(0.001), clearcoat_gloss);
  return shape;
}

// One channel of the tint of a base colour of the given luminance, 0.3 r + 0.6 g + 0.1 b; white where it is
// 0: no more than BRDF_TINY, below which slopes overflow and devices drop numbers.
BRDF_REAL_FUNCTION
Real burley_tint(Real base_color, Real base_luminance) {
  Real safe = select(base_luminance > REAL(BRDF_TINY), base_luminance, REAL(1.0));
  return select(base_luminance > REAL(BRDF_TINY), base_color / safe, REAL(1.0));
}

BRDF_REAL_FUNCTION
OF_REAL(BurleyColour)
burley_colour(Real base_color, Real base_luminance, Real metallic, Real specular, Real specular_tint,
              Real sheen, Real sheen_tint, Real clearcoat) {
  OF_REAL(BurleyColour) colour;
  Real tint = burley_tint(base_color, base_luminance);
  colour.rho = base_color * (REAL(1.0) - metallic);
  colour.sheen = sheen * lerp_real(REAL(1.0), tint, sheen_tint) * (REAL(1.0) - metallic);
  colour.f0 = metallic_f0(base_color, metallic, specular * lerp_real(REAL(1.0), tint, specular_tint));
  colour.clearcoat = clearcoat;
  return colour;
}

// The diffuse lobe per unit rho, without the cosine.
BRDF_FUNCTION
Real burley_diffuse(Real roughness, Real subsurface, OF_GEO(Geometry) g, int effects) {
  Geo fl = pow5(GEO(1.0) - g.cos_i);
  Geo fv = pow5(GEO(1.0) - g.cos_o);
  Real retro = (g.cos_d * g.cos_d) * roughness;
  Real fd90 = REAL(0.5) + REAL(2.0) * retro;
  Real fd = (REAL(1.0) + (fd90 - REAL(1.0)) * fl) * (REAL(1.0) + (fd90 - REAL(1.0)) * fv);
  if ((effects & BRDF_EFFECT_SUBSURFACE) != 0) {
    Real fss = (REAL(1.0) + (retro - REAL(1.0)) * fl) * (REAL(1.0) + (retro - REAL(1.0)) * fv);
    Geo spread = GEO(1.0) / at_least(g.cos_i + g.cos_o, GEO(BRDF_TINY)) - GEO(0.5);
    Real ss = REAL(1.25) * (fss * spread + REAL(0.5));
    fd = lerp_real(fd, ss, subsurface);
  }
  return REAL(BRDF_INV_PI) * fd;
}

// V of the specular lobe.
BRDF_FUNCTION
Real burley_v(OF_REAL(BurleyShape) shape, OF_GEO(Geometry) g, int burley_g, int effects) {
  if (burley_g == BRDF_BURLEY_G_2012) {
    Real alpha = square(REAL(0.5) + REAL(0.5) * shape.roughness);
    return smith_share(alpha, g.cos_i) * smith_share(alpha, g.cos_o);
  }
  if ((effects & BRDF_EFFECT_ANISOTROPIC) != 0) {
    return smith_share_anisotropic(shape.alpha_x, shape.alpha_y, g.wi_x, g.wi_y, g.cos_i) *
           smith_share_anisotropic(shape.alpha_x, shape.alpha_y, g.wo_x, g.wo_y, g.cos_o);
  }
  return smith_share(shape.alpha_x, g.cos_i) * smith_share(shape.alpha_x, g.cos_o);
}

// D of the specular lobe.
BRDF_FUNCTION
Real burley_d(OF_REAL(BurleyShape) shape, OF_GEO(Geometry) g, int effects) {
  if ((effects & BRDF_EFFECT_ANISOTROPIC) != 0) {
    return ggx_d_anisotropic(shape.alpha_x, shape.alpha_y, g.h_x, g.h_y, g.cos_h);
  }
  return ggx_d(shape.alpha_x, g.h_x * g.h_x + g.h_y * g.h_y, g.cos_h);
}

BRDF_FUNCTION
OF_REAL(BurleyLine) burley_line(OF_REAL(BurleyShape) shape, OF_GEO(Geometry) g, int effects) {
  OF_REAL(BurleyLine) line;
  Geo fh = schlick_falloff(g);
  line.falloff = TO_REAL(fh);
  line.d = burley_d(shape, g, effects);
  line.clearcoat_d = REAL(0.0);
  line.clearcoat_f = REAL(0.0);
  if ((effects & BRDF_EFFECT_CLEARCOAT) != 0) {
    line.clearcoat_d = gtr1_d(shape.clearcoat_alpha, g.h_x * g.h_x + g.h_y * g.h_y, g.cos_h);
    line.clearcoat_f = TO_REAL(GEO(0.25) * fresnel(GEO(0.04), fh));
  }
  return line;
}

// D V of the specular lobe.
BRDF_FUNCTION
Real burley_lobe(OF_REAL(BurleyShape) shape, OF_REAL(BurleyLine) line, OF_GEO(Geometry) g, int burley_g,
                 int effects) {
  return line.d * burley_v(shape, g, burley_g, effects);
}

BRDF_FUNCTION
OF_REAL(BurleyTerms)
burley_terms_of_line(OF_REAL(BurleyShape) shape, OF_REAL(BurleyLine) line, Real lobe, OF_GEO(Geometry) g,
                     int effects) {
  OF_REAL(BurleyTerms) terms;
  terms.diffuse = burley_diffuse(shape.roughness, shape.subsurface, g, effects) * g.cos_i;
  terms.sheen = line.falloff * g.cos_i;
  terms.falloff = line.falloff;
  terms.specular = lobe * g.cos_i;
  terms.clearcoat = REAL(0.0);
  if ((effects & BRDF_EFFECT_CLEARCOAT) != 0) {
    Geo v = smith_share(GEO(0.25), g.cos_i) * smith_share(GEO(0.25), g.cos_o);
    terms.clearcoat = line.clearcoat_d * (line.clearcoat_f * v) * g.cos_i;
  }
  return terms;
}

BRDF_FUNCTION
OF_REAL(BurleyTerms)
burley_terms(OF_REAL(BurleyShape) shape, OF_GEO(Geometry) g, int burley_g, int effects) {
  OF_REAL(BurleyLine) line = burley_line(shape, g, effects);
  Real lobe = burley_lobe(shape, line, g, burley_g, effects);
  return burley_terms_of_line(shape, line, lobe, g, effects);
}

BRDF_REAL_FUNCTION
Real burley_combine(OF_REAL(BurleyColour) colour, OF_REAL(BurleyTerms) terms) {
  return colour.rho * terms.diffuse + colour.sheen * terms.sheen +
         fresnel(colour.f0, terms.falloff) * terms.specular + colour.clearcoat * terms.clearcoat;
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_BURLEY_H_
