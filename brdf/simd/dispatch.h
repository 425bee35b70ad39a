// Which vector code this machine can run, and functions by instruction set.
#ifndef BRDFIT_BRDF_SIMD_DISPATCH_H_
#define BRDFIT_BRDF_SIMD_DISPATCH_H_

#include <span>
#include <string_view>

#include "brdf/material.h"
#include "brdf/simd/jobs.h"

namespace brdfit::simd {

enum class Isa { kBaseline, kAvx2, kAvx512 };

std::string_view name_of(Isa isa);

// Those that this build holds and this machine runs, slowest first.
std::span<const Isa> available_isas();

// The fastest of them. Results differ between instruction sets in the last digits only.
Isa best_isa();

EvalColumns eval_columns(Isa isa);
EvalDirections eval_directions(Isa isa);
EvalLines eval_lines(Isa isa);

// A material's coefficients as vector code takes them.
Coefficients coefficients_of(const Material& material);

}  // namespace brdfit::simd

// Declares a function of vector code for every instruction set of the build, and BRDFIT_PICK chooses between
// them.
#ifdef BRDFIT_HAVE_X86_ISAS
#define BRDFIT_DECLARE_SIMD(declaration) \
  namespace baseline {                   \
  declaration;                           \
  }                                      \
  namespace avx2 {                       \
  declaration;                           \
  }                                      \
  namespace avx512 {                     \
  declaration;                           \
  }
#define BRDFIT_PICK(isa, function)                           \
  ((isa) == ::brdfit::simd::Isa::kAvx512 ? &avx512::function \
   : (isa) == ::brdfit::simd::Isa::kAvx2 ? &avx2::function   \
                                         : &baseline::function)
#else
#define BRDFIT_DECLARE_SIMD(declaration) \
  namespace baseline {                   \
  declaration;                           \
  }
#define BRDFIT_PICK(isa, function) (static_cast<void>(isa), &baseline::function)
#endif

#endif  // BRDFIT_BRDF_SIMD_DISPATCH_H_
