// What of glTF 2.0's reflectance (appendix B) depends on no direction: means over directions of
// view and light by their cosines, and the Phong lobe that stands for GGX where a method needs a
// lobe of spherical harmonics or of bins.
//                       [Walter07, GGX; Schlick94; derived: integrals, fits by least squares]
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_MICROFACET_H
#define CLGI_SHARED_MICROFACET_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

#define MICROFACET_LEAST_ALPHA 0.01f  // smoother surfaces reflect like this one

// roughness: [0, 1].
CLGI_INLINE float microfacet_alpha(float roughness) {
    float alpha = roughness * roughness;
    return alpha > MICROFACET_LEAST_ALPHA ? alpha : MICROFACET_LEAST_ALPHA;
}

// Albedo of GGX where all of F is 1, within 0.0006 for every alpha in [0.01, 1].
CLGI_INLINE float microfacet_albedo(float alpha) {
    float sum = 0.62678816f * alpha - 2.2569896f;
    sum = sum * alpha + 3.31316328f;
    sum = sum * alpha - 2.19534853f;
    sum = sum * alpha - 0.11230094f;
    sum = sum * alpha + 1.00143666f;
    return sum < 1.0f ? sum : 1.0f;
}

// Albedo of GGX where F is (1 - v.h)^5, within 0.0003 for the same alpha; 1/21 of a mirror.
CLGI_INLINE float microfacet_grazing(float alpha) {
    return 1.0f /
           (((87.33208766f * alpha + 298.14145951f) * alpha + 59.82343764f) * alpha + 20.49600209f);
}

// Mean of (1 - v.h)^5 over directions v and l alone.
#define MICROFACET_DIFFUSE_GRAZING 0.0037f

// x: diffuse share of the base colour, y: coat, white, z: lobe share of the base colour, w:
// exponent of the lobe, from metalness, alpha, and F at normal and at grazing incidence of what is
// no metal.
//   A, B       albedos above;  n = 0.11/alpha^2 + 0.55/alpha - 1.2, which has GGX's mean cosine
//   coat       (1 - m)(f0 (A - B) + f90 B) + m B
// Of a metal's lobe the share alpha^2 counts as diffuse. metallic, f0 <= f90: [0, 1]; alpha:
// [0.01, 1].
CLGI_INLINE float4 microfacet_means(float metallic, float alpha, float f0, float f90) {
    float grazing = microfacet_grazing(alpha), normal = microfacet_albedo(alpha) - grazing;
    float coat = f0 * normal + f90 * grazing;
    float refracted = 1.0f - f0 - (f90 - f0) * MICROFACET_DIFFUSE_GRAZING;
    float diffuse = refracted < 1.0f - coat ? refracted : 1.0f - coat;
    float exponent = 0.11f / (alpha * alpha) + 0.55f / alpha - 1.2f;
    float4 out;
    out.x = (1.0f - metallic) * diffuse + metallic * alpha * alpha * normal;
    out.y = (1.0f - metallic) * coat + metallic * grazing;
    out.z = metallic * (1.0f - alpha * alpha) * normal;
    out.w = exponent > 0.0f ? exponent : 0.0f;
    return out;
}

CLGI_SHARED_END

#endif
