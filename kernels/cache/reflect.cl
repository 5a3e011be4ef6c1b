// What smooth lobes reflect: directions drawn from glTF's lobe, each followed by a ray to what it
// meets.
//
//   L = 1/K sum_k F G_1(l_k) L(l_k),   L(l) = L_e + D + rho/pi E, or L_sky
//                                           l_k: directions of the lobe (microfacet_sample.clh)
//                                           E: of records (lookup.clh), D: direct light that is
//                                           reflected back along the ray (link.clh)
//
// Of smooth surfaces that a ray meets E counts by their diffuse share, and another ray follows for
// what their lobes reflect, up to REFLECT_HOPS one after another. Lobes of larger alpha than
// params.smooth are wide enough for what records have around them (gloss.cl). Below the surface there
// is nothing to reflect.          [Whitted80: rays of reflected light; Cook84: by lobes; derived]
//
// Work size    1D, one work-item for every CLGI_WIDTH pixels (rounded up); any local size
// Writes       radiance of its own pixels; values that are not finite are counted and left out
// Cost         a ray, and as link.cl a pixel, a direction
// SPDX-License-Identifier: MIT
#include "cache/link.clh"
#include "cache/pixel_lobe.clh"
#include "gbuffer/ray.clh"
#include "gloss.clh"

#define REFLECT_LIFT 4e-6f    // of coordinates: what rounding may put a point below its surface
#define REFLECT_DOUBT 1e-6f   // of distances to corners: what rounding may put a triangle nearer
#define REFLECT_WIDEST 0.01f  // steradians that a direction may stand for
#define REFLECT_FOLLOWED 0.2f  // alpha of lobes that rays go on from
#define REFLECT_HOPS 4        // rays one after another; what the last one meets counts as diffuse

// A view of one pixel along a direction, which a ray goes through.
static View reflect_view(float3 from, float3 direction, float near) {
    float3 helper = fabs(direction.x) < 0.6f ? (float3)(1.0f, 0.0f, 0.0f) : (float3)(0.0f, 1.0f, 0.0f);
    float3 right = normalize(cross(direction, helper));
    View out;
    out.eye = (float4)(from, 0.0f);
    out.right = (float4)(right, 1.0f);
    out.up = (float4)(cross(right, direction), 1.0f);
    out.forward = (float4)(direction, near);
    out.window = (float4)(0.0f);
    out.width = out.height = 1;
    out.first_pixel = 0;
    out.flags = 0;
    return out;
}

// Where the rays of a packet begin and go, and what their light is multiplied by on its way to the
// eye. Those that go nowhere have no factor.
typedef struct {
    float3 from[CLGI_WIDTH], toward[CLGI_WIDTH], factor[CLGI_WIDTH];
    int goes[CLGI_WIDTH];
    float angle;  // solid angle that each stands for, at most
} ReflectRays;

// Sends ray k in a direction of a lobe. side: the geometric normal; factor: of what the lobe reflects;
// share: of all directions that are drawn.
static void reflect_send(const PixelLobe* lobe, float3 side, float3 numbers, float3 factor, float share,
                         int k, ReflectRays* rays) {
    float3 reflected;
    float density = pixel_lobe_direction(lobe, numbers, &rays->toward[k], &reflected);
    rays->goes[k] = density > 0.0f && dot(side, rays->toward[k]) > 0.0f;
    if (!rays->goes[k]) return;
    float3 size = fabs(lobe->point);
    rays->from[k] = lobe->point + REFLECT_LIFT * (size.x + size.y + size.z) * side;
    rays->factor[k] = factor * reflected;
    rays->angle = fmin(rays->angle, share / density);
}

CLGI_INLINE floatp reflect_row(const float3* values, int axis) {
    float lanes[CLGI_WIDTH];
    for (int k = 0; k < CLGI_WIDTH; ++k)
        lanes[k] = axis == 0 ? values[k].x : axis == 1 ? values[k].y : values[k].z;
    return packet_load(lanes);
}

// The lobes of what a packet of rays meets. Returns in which lanes they are to be followed.
static ulong reflect_lobes(const LinkWorld* world, const ViewRays* rays, float smooth,
                           const LinkPacket* packet, const Surface* seen, PixelLobe* lobes) {
    ulong out = 0;
    for (int k = 0; k < CLGI_WIDTH; ++k) {
        if (packet->at.seen[k] < 0) continue;
        uint4 triangle = world->scene.triangles[packet->at.seen[k]];
        global const MaterialRecord* of = world->scene.materials + (triangle.w & TRIANGLE_MATERIAL);
        if (!packet->front[k] && !(triangle.w & (uint)TRIANGLE_DOUBLE_SIDED)) continue;
        float4 s = of->surface;
        int finished = of->metallic_roughness_texture >= 0;
        if (finished || (s.y <= smooth && s.x + s.z + s.w > 0.0f)) out |= (ulong)1 << k;
    }
    if (!out) return out;
    intp mapped, metallic_roughness, triangle = packet_load(packet->at.seen);
    Surface surface = *seen;
    gbuffer_detail(rays, triangle, &world->scene, world->flags, &surface, &mapped, &metallic_roughness);
    detail_normals(mapped, &surface.normal_x, &surface.normal_y, &surface.normal_z);
    floatp place[9] = {surface.x,        surface.y,        surface.z,
                       surface.normal_x, surface.normal_y, surface.normal_z,
                       rays->dx,         rays->dy,         rays->dz};
    float lane[9][CLGI_WIDTH];
    int code[CLGI_WIDTH];
    for (int i = 0; i < 9; ++i) packet_store(place[i], lane[i]);
    packet_store(metallic_roughness, code);
    for (int k = 0; k < CLGI_WIDTH; ++k) {
        if (!(out >> k & 1)) continue;
        uint4 of = world->scene.triangles[packet->at.seen[k]];
        PixelLobe* lobe = lobes + k;
        pixel_lobe_finish(
            detail_surface(world->scene.materials[of.w & TRIANGLE_MATERIAL].surface, code[k]), lobe);
        if (lobe->alpha > smooth) {
            out &= ~((ulong)1 << k);
            continue;
        }
        lobe->point = (float3)(lane[0][k], lane[1][k], lane[2][k]);
        lobe->base = (float3)(packet->base[0][k], packet->base[1][k], packet->base[2][k]);
        pixel_lobe_frame(normalize((float3)(lane[3][k], lane[4][k], lane[5][k])),
                         -(float3)(lane[6][k], lane[7][k], lane[8][k]), lobe);
    }
    return out;
}

kernel void cache_reflect(
    const CacheGlossParams        lobes,
    RECORD_WORLD_ARGUMENTS,
    global const float*           restrict light,     // [3][stride] exposed lux
    global const BoxNode*         restrict boxes,
    global const Cluster*         restrict clusters,
    global const PartCorners*     restrict parts,
    global const float*           restrict whole_sky,  // [sky_height][sky_width][3]
    global const float*           restrict pixels,    // [GBUFFER_PLANES][lobes.stride]
    global const int*             restrict ids,       // [GBUFFER_ID_PLANES][lobes.stride]
    global float*                 restrict radiance,  // [RADIANCE_PLANES][lobes.stride] cd/m^2
    global uint*                  restrict non_finite)  // [1]
{
    uint first = (uint)get_global_id(0) * CLGI_WIDTH, stride = lobes.stride;
    if (first >= lobes.pixel_count) return;
    int lanes = (int)min(lobes.pixel_count - first, (uint)CLGI_WIDTH), smooth[CLGI_WIDTH], any = 0;
    for (int k = 0; k < CLGI_WIDTH; ++k) {
        smooth[k] = 0;
        if (k >= lanes) continue;
        float3 normal = gbuffer_load3(pixels, GBUFFER_NORMAL, stride, first + k);
        float4 surface = pixel_surface(ids, materials, stride, first + k);
        smooth[k] = dot(normal, normal) > 0.0f && surface.x + surface.z + surface.w > 0.0f &&
                    surface.y <= lobes.smooth;
        any |= smooth[k];
    }
    if (!any) return;
    LinkWorld world = LINK_WORLD;
    float share = 1.0f / (float)lobes.shared;
    float3 sums[CLGI_WIDTH];
    for (int k = 0; k < CLGI_WIDTH; ++k) sums[k] = (float3)(0.0f);
    for (uint n = 0; n < lobes.directions; ++n) {
        ReflectRays rays;
        rays.angle = REFLECT_WIDEST;
        for (int k = 0; k < CLGI_WIDTH; ++k) {
            rays.goes[k] = 0;
            rays.from[k] = rays.factor[k] = (float3)(0.0f);
            rays.toward[k] = (float3)(0.0f, 0.0f, 1.0f);
            if (!smooth[k]) continue;
            PixelLobe lobe = pixel_lobe(&lobes, pixels, ids, materials, first + k);
            reflect_send(&lobe, gbuffer_load3(pixels, GBUFFER_GEOMETRIC, stride, first + k),
                         gloss_numbers(first + k, lobes.first_direction + n), (float3)(1.0f), share, k,
                         &rays);
        }
        for (int hop = 0; hop < REFLECT_HOPS; ++hop) {
            LinkPacket packet;
            int some = 0;
            for (int k = 0; k < CLGI_WIDTH; ++k) {
                packet.at.seen[k] = -1;
                packet.at.factor[k] = 1.0f;
                if (!rays.goes[k]) continue;
                float3 size = fabs(rays.from[k]);
                View view = reflect_view(rays.from[k], rays.toward[k],
                                         REFLECT_LIFT * (size.x + size.y + size.z) + FLT_MIN);
                RayScene of = {&view, info.flags, info.triangle_count - 1, boxes, clusters, parts,
                               &world.scene, REFLECT_DOUBT};
                int met = visibility_triangle(ray_word(&of, 0, 0));
                packet.at.seen[k] = met;
                some |= met >= 0;
                if (met >= 0) continue;
                rays.goes[k] = 0;
                if (lobes.sky_width > 0)
                    sums[k] += rays.factor[k] * params.sky.xyz *
                               vload3(sky_texel_of(params.sky_turn, lobes.sky_width,
                                                  lobes.sky_height, rays.toward[k]),
                                     whole_sky);
            }
            if (!some) break;
            ViewRays sight = {reflect_row(rays.from, 0),   reflect_row(rays.from, 1),
                              reflect_row(rays.from, 2),   reflect_row(rays.toward, 0),
                              reflect_row(rays.toward, 1), reflect_row(rays.toward, 2),
                              reflect_row(rays.toward, 0), reflect_row(rays.toward, 1),
                              reflect_row(rays.toward, 2)};
            View pixel = reflect_view((float3)(0.0f), (float3)(0.0f, 0.0f, 1.0f), 0.0f);
            pixel.window.w = CUBE_FOOTPRINT;
            pixel.right.w = pixel.up.w = 0.5f * sqrt(rays.angle);
            Surface surface = link_hits(&world, &pixel, &sight, 0.25f * rays.angle,
                                        first / CLGI_WIDTH + n, info.flags, &packet);
            CacheVector there = cache_light(&packet.share, light, tree.stride);
            float found[3][CLGI_WIDTH], side[3][CLGI_WIDTH];
            packet_store(there.x, found[0]);
            packet_store(there.y, found[1]);
            packet_store(there.z, found[2]);
            packet_store(surface.geometric_x, side[0]);
            packet_store(surface.geometric_y, side[1]);
            packet_store(surface.geometric_z, side[2]);
            PixelLobe next[CLGI_WIDTH];
            ulong follows = 0;
            if (hop + 1 < REFLECT_HOPS)
                follows = reflect_lobes(&world, &sight, REFLECT_FOLLOWED, &packet, &surface, next);
            for (int k = 0; k < CLGI_WIDTH; ++k) {
                if (!rays.goes[k]) continue;
                int on = (int)(follows >> k & 1);
                float4 shares = link_shares(&world, &packet, k);
                if (on) {
                    shares = microfacet_means(next[k].metallic, next[k].alpha, next[k].f0, next[k].f90);
                    shares.y = shares.z = 0.0f;
                }
                float3 factor = rays.factor[k];
                sums[k] += factor * link_radiance(&world, &packet, found, shares, k);
                rays.goes[k] = 0;
                if (on)
                    reflect_send(next + k, link_lane(side, k),
                                 gloss_numbers(first + k + (uint)(hop + 1) * 0x632be5abu,
                                               lobes.first_direction + n),
                                 factor, share, k, &rays);
            }
        }
    }
    for (int k = 0; k < lanes; ++k) {
        if (!smooth[k]) continue;
        float3 sum = sums[k] * (1.0f / (float)lobes.directions);
        add_reflected(first + k, lobes.exposure, sum.x, radiance, non_finite);
        add_reflected(stride + first + k, lobes.exposure, sum.y, radiance, non_finite);
        add_reflected(2 * stride + first + k, lobes.exposure, sum.z, radiance, non_finite);
    }
}
