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
// eye.
typedef struct {
    CacheVector from, toward, factor;
    intp goes;
    float angle;  // solid angle that each stands for, at most
} ReflectRays;

// Sends rays in directions of lobes, where they go on. side: the geometric normals; share: of all
// directions that are drawn.
static void reflect_send(const PixelLobe* lobe, CacheVector side, CacheVector numbers, float share,
                         ReflectRays* rays) {
    CacheVector reflected;
    floatp density = pixel_lobe_direction(lobe, numbers, &rays->toward, &reflected);
    rays->goes &= (density > 0.0f) & (cache_dot(side, rays->toward) > 0.0f);
    floatp lift = REFLECT_LIFT * (fabs(lobe->point.x) + fabs(lobe->point.y) + fabs(lobe->point.z));
    rays->from.x = fma(lift, side.x, lobe->point.x);
    rays->from.y = fma(lift, side.y, lobe->point.y);
    rays->from.z = fma(lift, side.z, lobe->point.z);
    rays->factor.x *= reflected.x;
    rays->factor.y *= reflected.y;
    rays->factor.z *= reflected.z;
    float lane[CLGI_WIDTH];
    packet_store(packet_select(packet_splat(REFLECT_WIDEST), share / density, rays->goes), lane);
    for (int k = 0; k < CLGI_WIDTH; ++k) rays->angle = fmin(rays->angle, lane[k]);
}

CLGI_INLINE void reflect_lanes(CacheVector v, float lanes[3][CLGI_WIDTH]) {
    packet_store(v.x, lanes[0]);
    packet_store(v.y, lanes[1]);
    packet_store(v.z, lanes[2]);
}

// The lobes of what a packet of rays meets, and their metalness, alpha, f0 and f90. Returns where they
// are to be followed.
static intp reflect_lobes(const LinkWorld* world, const ViewRays* rays, float smooth,
                          const LinkPacket* packet, const Surface* seen, float4* of_lobe,
                          PixelLobe* lobe) {
    int follows[CLGI_WIDTH], code[CLGI_WIDTH];
    for (int k = 0; k < CLGI_WIDTH; ++k) {
        of_lobe[k] = (float4)(0.0f, 1.0f, 0.0f, 0.0f);
        follows[k] = 0;
        if (packet->at.seen[k] < 0) continue;
        uint4 triangle = world->scene.triangles[packet->at.seen[k]];
        global const MaterialRecord* of = world->scene.materials + (triangle.w & TRIANGLE_MATERIAL);
        if (!packet->front[k] && !(triangle.w & (uint)TRIANGLE_DOUBLE_SIDED)) continue;
        float4 s = of_lobe[k] = of->surface;
        int finished = of->metallic_roughness_texture >= 0;
        follows[k] = finished || (s.y <= smooth && s.x + s.z + s.w > 0.0f) ? -1 : 0;
    }
    intp out = packet_load(follows);
    if (!packet_any(out)) return out;
    intp mapped, metallic_roughness, triangle = packet_load(packet->at.seen);
    Surface surface = *seen;
    gbuffer_detail(rays, triangle, &world->scene, world->flags, &surface, &mapped, &metallic_roughness);
    detail_normals(mapped, &surface.normal_x, &surface.normal_y, &surface.normal_z);
    packet_store(metallic_roughness, code);
    for (int k = 0; k < CLGI_WIDTH; ++k)
        if (follows[k]) of_lobe[k] = detail_surface(of_lobe[k], code[k]);
    pixel_lobe_finish(of_lobe, lobe);
    CacheVector point = {surface.x, surface.y, surface.z};
    CacheVector base = {packet_load(packet->base[0]), packet_load(packet->base[1]),
                        packet_load(packet->base[2])};
    CacheVector normal = {surface.normal_x, surface.normal_y, surface.normal_z};
    CacheVector eye = {-rays->dx, -rays->dy, -rays->dz};
    lobe->point = point;
    lobe->base = base;
    pixel_lobe_frame(cache_normalized(normal), eye, lobe);
    return out & (lobe->alpha <= smooth);
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
    int lanes = (int)min(lobes.pixel_count - first, (uint)CLGI_WIDTH);
    float4 of_pixel[CLGI_WIDTH];
    intp smooth = pixel_lobe_surfaces(pixels, ids, materials, stride, first, lanes, of_pixel);
    smooth &= (floatp)(packet_collect(of_pixel, y)) <= lobes.smooth;
    if (!packet_any(smooth)) return;
    PixelLobe seen = pixel_lobe(&lobes, pixels, ids, of_pixel, first, smooth);
    LinkWorld world = LINK_WORLD;
    float share = 1.0f / (float)lobes.shared;
    float3 sums[CLGI_WIDTH];
    for (int k = 0; k < CLGI_WIDTH; ++k) sums[k] = (float3)(0.0f);
    for (uint n = 0; n < lobes.directions; ++n) {
        ReflectRays rays;
        rays.angle = REFLECT_WIDEST;
        rays.goes = smooth;
        rays.factor.x = rays.factor.y = rays.factor.z = packet_splat(1.0f);
        reflect_send(&seen, cache_points(pixels, GBUFFER_GEOMETRIC, stride, first),
                     gloss_numbers(first, lobes.first_direction + n), share, &rays);
        for (int hop = 0; hop < REFLECT_HOPS; ++hop) {
            LinkPacket packet;
            float from[3][CLGI_WIDTH], toward[3][CLGI_WIDTH], factor[3][CLGI_WIDTH];
            int goes[CLGI_WIDTH], some = 0;
            reflect_lanes(rays.from, from);
            reflect_lanes(rays.toward, toward);
            reflect_lanes(rays.factor, factor);
            packet_store(rays.goes, goes);
            for (int k = 0; k < CLGI_WIDTH; ++k) {
                packet.at.seen[k] = -1;
                packet.at.factor[k] = 1.0f;
                if (!goes[k]) continue;
                float3 size = fabs(link_lane(from, k)), direction = link_lane(toward, k);
                View view = reflect_view(link_lane(from, k), direction,
                                         REFLECT_LIFT * (size.x + size.y + size.z) + FLT_MIN);
                RayScene of = {&view, info.flags, info.triangle_count - 1, boxes, clusters, parts,
                               &world.scene, REFLECT_DOUBT};
                int met = visibility_triangle(ray_word(&of, 0, 0));
                packet.at.seen[k] = met;
                some |= met >= 0;
                if (met < 0 && lobes.sky_width > 0)
                    sums[k] += link_lane(factor, k) * params.sky.xyz *
                               vload3(sky_texel_of(params.sky_turn, lobes.sky_width,
                                                   lobes.sky_height, direction),
                                      whole_sky);
            }
            if (!some) break;
            ViewRays sight = {rays.from.x,   rays.from.y,   rays.from.z,
                              rays.toward.x, rays.toward.y, rays.toward.z,
                              rays.toward.x, rays.toward.y, rays.toward.z};
            View pixel = reflect_view((float3)(0.0f), (float3)(0.0f, 0.0f, 1.0f), 0.0f);
            pixel.window.w = CUBE_FOOTPRINT;
            pixel.right.w = pixel.up.w = 0.5f * sqrt(rays.angle);
            Surface surface = link_hits(&world, &pixel, &sight, 0.25f * rays.angle,
                                        first / 16 + lobes.first_direction + n, info.flags, &packet);
            float found[3][CLGI_WIDTH];
            reflect_lanes(cache_light(&packet.share, light, tree.stride), found);
            PixelLobe next;
            float4 of_next[CLGI_WIDTH];
            int follows[CLGI_WIDTH];
            intp on = (intp)(0);
            if (hop + 1 < REFLECT_HOPS)
                on = reflect_lobes(&world, &sight, REFLECT_FOLLOWED, &packet, &surface, of_next,
                                   &next);
            packet_store(on, follows);
            for (int k = 0; k < CLGI_WIDTH; ++k) {
                if (packet.at.seen[k] < 0) continue;
                float4 shares = link_shares(&world, &packet, k);
                if (follows[k]) {
                    float4 s = of_next[k];
                    shares = (float4)(microfacet_means(s.x, s.y, s.z, s.w).x, 0.0f, 0.0f, 0.0f);
                }
                sums[k] += link_lane(factor, k) * link_radiance(&world, &packet, found, shares, k);
            }
            if (!packet_any(on)) break;
            rays.goes = on;
            CacheVector side = {surface.geometric_x, surface.geometric_y, surface.geometric_z};
            reflect_send(&next, side,
                         gloss_numbers(first + (uint)(hop + 1) * 0x632be5abu,
                                       lobes.first_direction + n),
                         share, &rays);
        }
    }
    int reflects[CLGI_WIDTH];
    packet_store(smooth, reflects);
    for (int k = 0; k < lanes; ++k) {
        if (!reflects[k]) continue;
        float3 sum = sums[k] * (1.0f / (float)lobes.directions);
        add_reflected(first + k, lobes.exposure, sum.x, radiance, non_finite);
        add_reflected(stride + first + k, lobes.exposure, sum.y, radiance, non_finite);
        add_reflected(2 * stride + first + k, lobes.exposure, sum.z, radiance, non_finite);
    }
}
