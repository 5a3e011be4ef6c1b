// VPLs: each sample of an emitter is followed to the surface that its views show.
//
//   dPhi = I(w) dw          light of the share (directional: E dA, area: Phi / N)
//   Phi  = rho dPhi         what the surface sends on, as a cosine lobe of intensity Phi cos / pi
//   E(p) = sum Phi cos cos' / (pi d^2)  ->  integral of rho E cos cos' / (pi d^2) dA
//
// because dPhi = E dA on the lit surface: with N the sum becomes the one-bounce unshadowed
// integral. The share's footprint A = dw d^2 / cos, the disc that the VPL represents, bounds the
// kernel near by (lights/disc.clh); it goes to 0 as N grows.        [Cochran07, section 3.1]
//
// Unlike paper  the surface is met at the sample itself, not at the centre of its pixel, so a
//               VPL stays in place when its light turns
// Work size     1D, one work-item a VPL; any local size; tail guarded
// Writes        its own VPL; flux 0 where the sample leaves the scene or meets a back face
// SPDX-License-Identifier: MIT
#include "gbuffer/locate.clh"
#include "gbuffer/hit.clh"
#include "gbuffer/visibility.clh"
#include "lights/sample.clh"

kernel void lights_fetch(
    const FetchParams      params,
    const SceneInfo        info,
    global const Emitter*  restrict emitters,    // [emitter_count]
    global const View*     restrict views,       // of all emitters
    global const ulong*    restrict visibility,  // [pixels of all views]
    global const uint*     restrict accepted,    // [vpl_count] from lights_accept_list
    SCENE_ARGUMENTS,
    global Vpl*  restrict lights)      // [vpl_count]
{
    uint light = (uint)get_global_id(0);
    if (light >= params.vpl_count) return;
    SceneBuffers scene = SCENE_BUFFERS;

    uint e = 0;
    while (e + 1 < params.emitter_count && light >= emitters[e + 1].first_vpl) ++e;
    global const Emitter* emitter = emitters + e;
    uint rank = light - emitter->first_vpl;
    uint index = emitter->kind == EMITTER_SPOT ? accepted[light] : emitter->first_index + rank;

    Vpl out;
    out.position = (float4)(0.0f);
    out.normal = (float4)(0.0f);
    out.flux = (float4)(0.0f);
    if (index != 0) {
        LightSample sample = sample_emitter(emitter, index);
        ViewPoint seen = gbuffer_locate(views, emitter->first_view, emitter->view_count,
                                        sample.origin + sample.direction);
        if (seen.view >= 0) {
            View view = views[seen.view];
            uint x = min((uint)seen.pixel.x, view.width - 1);
            uint y = min((uint)seen.pixel.y, view.height - 1);
            int triangle = visibility_triangle(visibility[view.first_pixel + y * view.width + x]);
            floatp zero = packet_zero;
            Surface surface = view_surface(&view, packet_splat(seen.plane.x), packet_splat(seen.plane.y),
                                           (intp)(triangle), &scene, info.flags);
            float lanes[11][CLGI_WIDTH];
            int front[CLGI_WIDTH];
            packet_store(surface.x, lanes[0]);
            packet_store(surface.y, lanes[1]);
            packet_store(surface.z, lanes[2]);
            packet_store(surface.normal_x, lanes[3]);
            packet_store(surface.normal_y, lanes[4]);
            packet_store(surface.normal_z, lanes[5]);
            packet_store(surface.base_r, lanes[6]);
            packet_store(surface.base_g, lanes[7]);
            packet_store(surface.base_b, lanes[8]);
            packet_store(surface.front, front);
            int sends = triangle >= 0 &&
                        (front[0] || (triangles[triangle].w & (uint)TRIANGLE_DOUBLE_SIDED));
            if (sends) {
                float3 position = (float3)(lanes[0][0], lanes[1][0], lanes[2][0]);
                float3 normal = (float3)(lanes[3][0], lanes[4][0], lanes[5][0]);
                float3 base = (float3)(lanes[6][0], lanes[7][0], lanes[8][0]);
                uint material = triangles[triangle].w & TRIANGLE_MATERIAL;
                float3 albedo = base * materials[material].reflectance.x;
                float distance = length(position - sample.origin);
                float cosine = max(-dot(normal, sample.direction), 0.01f);
                int parallel = emitter->kind == EMITTER_DIRECTIONAL;
                float area = sample.spread * (parallel ? 1.0f : distance * distance) / cosine;
                float falloff = parallel ? 1.0f : range_falloff_one(distance, emitter->range);
                float radius2 = params.footprint * area / CLGI_PI;
                out.position = (float4)(position, radius2);
                out.normal = (float4)(normal, radius2 * radius2);
                float factor = falloff * params.scale * emitter->taken_over;
                out.flux = (float4)(albedo * sample.flux * factor, 1.0f);
            }
        }
    }
    lights[light] = out;
}
