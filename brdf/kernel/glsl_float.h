// What lang.h defines for C++, as GLSL: with float alone, formulas that cancel take more care.
//
// Plain GLSL, and HLSL but for the names of the bit casts.
#ifndef BRDFIT_BRDF_KERNEL_GLSL_FLOAT_H_
#define BRDFIT_BRDF_KERNEL_GLSL_FLOAT_H_

float select(bool condition, float yes, float no) {
  return condition ? yes : no;
}

// A float without its lower 12 bits: products of such halves are exact.
float upper_half(float x) {
  return uintBitsToFloat(floatBitsToUint(x) & 0xfffff000u);
}

// The rounding error of product = a b (Dekker 1971).
float product_error(float a, float b, float product) {
  precise float a_1 = upper_half(a);
  precise float a_2 = a - a_1;
  precise float b_1 = upper_half(b);
  precise float b_2 = b - b_1;
  precise float rest = ((a_1 * b_1 - product) + a_1 * b_2 + a_2 * b_1) + a_2 * b_2;
  return rest;
}

// The rounding error of sum = a + b (Knuth 1969).
float sum_error(float a, float b, float sum) {
  precise float b_taken = sum - a;
  precise float rest = (a - (sum - b_taken)) + (b - b_taken);
  return rest;
}

// As in twice the precision (Ogita, Rump and Oishi 2005).
float accurate_dot(float a_x, float a_y, float a_z, float b_x, float b_y, float b_z) {
  precise float x = a_x * b_x;
  precise float y = a_y * b_y;
  precise float z = a_z * b_z;
  precise float xy = x + y;
  precise float xyz = xy + z;
  precise float errors = product_error(a_x, b_x, x) + product_error(a_y, b_y, y) +
                         product_error(a_z, b_z, z) + sum_error(x, y, xy) + sum_error(xy, z, xyz);
  precise float dot_product = xyz + errors;
  return dot_product;
}

float scale_before_squares(float sum) {
  return select(sum > 1e-30, 1.0, 1.2676506002282294e30);
}

float accurate_log(float x, float one_minus_x) {
  // log(1 - d) = -2 artanh(d / (2 - d))
  float z = one_minus_x / (2.0 - one_minus_x);
  float z2 = z * z;
  float series = -2.0 * z * (1.0 + z2 * (1.0 / 3.0 + z2 * (1.0 / 5.0 + z2 * (1.0 / 7.0))));
  return select(one_minus_x < 0.25, series, log(x));
}

float one_minus_exp(float x, float exp_x) {
  float tail = 1.0 + x / 5.0 * (1.0 + x / 6.0 * (1.0 + x / 7.0 * (1.0 + x / 8.0 * (1.0 + x / 9.0))));
  float series = -x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0 * tail)));
  return select(x > -0.5, series, 1.0 - exp_x);
}

#endif  // BRDFIT_BRDF_KERNEL_GLSL_FLOAT_H_
