// Negative VPLs: at points of the camera image, the light of VPLs that reaches the back of the
// surface, and that a VPL without shadow would let through.
//
//   back_l(p) = Phi_l cos_l max(0, -n_p.t_l) k(d, A_l),  t_l from p to VPL l
//   E_n(p)    = sum_l back_l,   Phi_n = E_n(p) A_p
//   direction = - sum_l w_l t_l / |sum_l w_l t_l|,  w_l = luminance of back_l
//                                                              [Cochran07, section 3.3]
//
// A_p is the surface that the sample stands for: image pixels / samples times the footprint of a
// pixel, whose slant is bounded at 0.1. VPLs in front of the surface carry no weight: the mean is
// over the light that the surface stops.
//
// Unlike paper  only the sampled points are evaluated, not every pixel of the image; the mean
//               direction is over the VPLs behind the surface; behind is judged by the geometric
//               normal, so that interpolated normals stop no light
// Work size     1D, one work-item a sample; any local size; tail guarded
// Writes        its own negative VPL; flux 0 where nothing is stopped
// SPDX-License-Identifier: MIT
#include "clgi/shared/halton.h"
#include "clgi/shared/lights.h"
#include "lights/disc.clh"
#include "planes.clh"

kernel void lights_negative(
    const NegativeParams         params,
    const View                   view,
    global const float*          restrict planes,    // [GBUFFER_PLANES][stride]
    global const Vpl*  restrict lights,    // [vpl_count]
    global Vpl*        restrict negative)  // [negative_count]
{
    uint sample = (uint)get_global_id(0);
    if (sample >= params.negative_count) return;

    float right = shifted_radical_inverse(sample + 1, 2, params.shift_x);
    float down = shifted_radical_inverse(sample + 1, 3, params.shift_y);
    uint x = min((uint)(right * (float)view.width), view.width - 1);
    uint y = min((uint)(down * (float)view.height), view.height - 1);
    uint pixel = y * view.width + x;
    float3 p = gbuffer_load3(planes, GBUFFER_POSITION, params.stride, pixel);
    float3 n = gbuffer_load3(planes, GBUFFER_GEOMETRIC, params.stride, pixel);

    float3 stopped = (float3)(0.0f);
    float3 toward = (float3)(0.0f);
    if (dot(n, n) > 0.0f) {
        for (uint l = 0; l < params.vpl_count; ++l) {
            float4 position = lights[l].position;
            float3 t = position.xyz - p;
            float behind = -dot(n, t);
            float leaving = -dot(lights[l].normal.xyz, t);
            if (!(behind > params.back_facing) || !(leaving > 0.0f)) continue;
            float square = dot(t, t);
            float factor = disc_kernel_one(behind * leaving, square,
                                       position.w, lights[l].normal.w);
            float3 light = lights[l].flux.xyz * (factor / CLGI_PI);
            stopped += light;
            float weight = dot(light, (float3)(0.2126f, 0.7152f, 0.0722f));
            toward += t * (weight / sqrt(square));
        }
    }

    Vpl out;
    out.position = (float4)(0.0f);
    out.normal = (float4)(0.0f);
    out.flux = (float4)(0.0f);
    // Brought near 1 first: the square of a dim light's weight would vanish.
    float largest = max(fabs(toward.x), max(fabs(toward.y), fabs(toward.z)));
    if (largest > 0.0f) {
        toward /= largest;
        float3 d = p - view.eye.xyz;
        float z = dot(d, view.forward.xyz);
        float pixel = 4.0f * view.right.w * view.up.w;
        float slant = 1.0f;
        if (view.eye.w == 0.0f) {
            // The pixel's ray with forward component 1, and its cosine with the surface.
            float ray = length(d) / z;
            slant = max(fabs(dot(n, d)) / z, 0.1f * ray);
            pixel *= z * z;
        } else {
            slant = max(fabs(dot(n, view.forward.xyz)), 0.1f);
        }
        float area = pixel / (slant * (float)params.negative_count);
        float radius2 = params.footprint * area / CLGI_PI;
        out.position = (float4)(p, radius2);
        out.normal = (float4)(toward * (-1.0f / length(toward)), radius2 * radius2);
        out.flux = (float4)(stopped * area, 1.0f);
    }
    negative[sample] = out;
}
