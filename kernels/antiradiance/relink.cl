// Bins and form factors of links of which an end moved.
//                             [Dachsbacher07, sections 3.1 and 3.3, Eq. 17; derived: as make_links()]
//
// The bin is the one nearest to the way from the sender's part to the receiver among those that go
// off the side of a flat sender that faces it, and to the front of a flat receiver. A flat sender
// counts with the exact solid angle of its part [Van Oosterom, Strackee: The Solid Angle of a Plane
// Triangle. IEEE Transactions on Biomedical Engineering 30, 1983], the triple product written as
// twice the area times the height: that of three nearly equal unit vectors would lose bits.
//
// Work size    1D, one work-item a moving link; any local size; tail guarded
// Writes       bin and form factor of its link; both are 0 where no light arrives
// Cost         3 CLGI_BINS / 2 multiply-adds; 9 CLGI_BINS more where the nearest bin does not serve
// SPDX-License-Identifier: MIT
#include "clgi/shared/antiradiance.h"
#include "clgi/shared/moving_elements.h"
#include "antiradiance/triangle.clh"

#ifndef CLGI_BINS
#define CLGI_BINS 128
#endif

// Cosines of bins with normals, as the host demands them: a form factor is divided by the sender's.
#define LEAST_SENT 1e-2f
#define LEAST_RECEIVED 1e-6f
// What is nearer to a plane lies in it: eight spacings of floats at the frame's border.
#define LEAST_HEIGHT 0x1p-21f

CLGI_INLINE int is_zero(float3 v) { return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f; }

// A normal of zero demands nothing.
CLGI_INLINE int is_met(float3 normal, float least, float3 direction) {
    return is_zero(normal) || dot(normal, direction) >= least;
}

CLGI_INLINE uint nearest_bin(float3 direction, global const float4* directions) {
    uint best = 0;
    float most = -1.0f;
    int opposite = 0;
    for (uint bin = 0; bin < CLGI_BINS / 2; ++bin) {
        float along = dot(directions[bin].xyz, direction), size = fabs(along);
        if (size > most) {
            most = size;
            best = bin;
            opposite = along < 0.0f;
        }
    }
    return opposite ? best + CLGI_BINS / 2 : best;
}

// CLGI_BINS: none.
CLGI_INLINE uint choose_bin(float3 direction, float3 sends, float3 receives, float least_cosine,
                            global const float4* directions) {
    uint nearest = nearest_bin(direction, directions);
    float3 w = directions[nearest].xyz;
    if (is_met(sends, LEAST_SENT, w) && is_met(receives, LEAST_RECEIVED, w)) return nearest;
    uint best = CLGI_BINS;
    float most = least_cosine;
    for (uint bin = 0; bin < CLGI_BINS; ++bin) {
        w = directions[bin].xyz;
        float along = dot(w, direction);
        if (along > most && is_met(sends, LEAST_SENT, w) && is_met(receives, LEAST_RECEIVED, w)) {
            most = along;
            best = bin;
        }
    }
    return best;
}

// Corners of a part as weights of the triangle's second and third corner.
CLGI_INLINE void cut(float2* corners, uint quarter) {
    float2 m0 = 0.5f * (corners[0] + corners[1]), m1 = 0.5f * (corners[1] + corners[2]),
           m2 = 0.5f * (corners[2] + corners[0]);
    if (quarter != 0) corners[0] = quarter == 2 ? m2 : m0;
    if (quarter != 1) corners[1] = quarter == 0 ? m0 : m1;
    if (quarter != 2) corners[2] = quarter == 1 ? m1 : m2;
}

CLGI_INLINE float solid_angle(const float3* to, float twice_area_height) {
    float a = length(to[0]), b = length(to[1]), c = length(to[2]);
    if (!(a > 0.0f && b > 0.0f && c > 0.0f)) return 0.0f;
    float3 u = to[0] / a, v = to[1] / b, w = to[2] / c;
    return 2.0f * atan2(twice_area_height / a / b / c, 1.0f + dot(u, v) + dot(v, w) + dot(w, u));
}

kernel void antiradiance_relink(
    const RelinkParams         params,
    global const uint2*        restrict links,         // [count] moving links
    global const ElementPlace* restrict places,        // [elements]
    global const PatchCorners* restrict patches,       // [elements]
    global const uint4*        restrict triangles,     // of the scene
    global const float4*       restrict positions,     // of its vertices, local frame
    global const float4*       restrict directions,    // [CLGI_BINS] unit; w: sr
    global const uint*         restrict senders,       // of all links
    global ushort*             restrict bins,
    global float*              restrict form_factors)  // 1 / (area of the local frame, sr)
{
    uint at = (uint)get_global_id(0);
    if (at >= params.count) return;
    uint link = links[at].x;
    uint receiver = links[at].y & ((1u << PART_SHIFT) - 1u), part = links[at].y >> PART_SHIFT;
    uint sender = senders[link];
    ElementPlace to = places[receiver], from = places[sender];
    bins[link] = 0;
    form_factors[link] = 0.0f;

    int is_patch = from.triangle != ELEMENT_NONE;
    int is_flat = !is_zero(from.normal.xyz);
    float3 receives = -to.normal.xyz, sends = (float3)(0.0f);
    float3 way = to.position.xyz - from.position.xyz, start = from.position.xyz;
    float square = dot(way, way), height = dot(from.normal.xyz, way);
    if (!(square > 0.0f) || (is_patch && !is_flat)) return;
    if (is_flat) {
        if (!(fabs(height) > LEAST_HEIGHT)) return;
        sends = height > 0.0f ? from.normal.xyz : -from.normal.xyz;
    }
    float angle = is_flat ? from.area * fabs(height) / (square * sqrt(square)) : 1.0f;
    if (is_patch) {
        PatchCorners patch = patches[sender];
        float2 corners[3] = {patch.weights.xy, patch.weights.zw, patch.last.xy};
        float area = from.area;
        if (part >= PART_QUARTERS) {
            cut(corners, part < PART_SIXTEENTHS ? part - PART_QUARTERS : (part - PART_SIXTEENTHS) / 4);
            area *= 0.25f;
        }
        if (part >= PART_SIXTEENTHS) {
            cut(corners, (part - PART_SIXTEENTHS) % 4);
            area *= 0.25f;
        }
        Triangle whole = triangle_of(triangles[from.triangle], positions);
        float3 edges[3];
        start = (float3)(0.0f);
        for (int k = 0; k < 3; ++k) {
            float3 corner = point_at(whole, corners[k]);
            edges[k] = corner - to.position.xyz;
            start += edges[k];
        }
        start = fma((float3)(1.0f / 3.0f), start, to.position.xyz);
        angle = solid_angle(edges, 2.0f * area * fabs(height));
    }
    float3 along = to.position.xyz - start;
    float distance = length(along);
    if (!(angle > 0.0f && distance > 0.0f)) return;
    if (!is_met(receives, LEAST_HEIGHT, along)) return;
    uint bin = choose_bin(along / distance, sends, receives, params.least_cosine, directions);
    if (bin == CLGI_BINS) return;

    // Light that was let through comes from behind to what lies further along the bin, or it could
    // go round in a bin for ever.
    float4 w = directions[bin];
    int before = is_flat && height > 0.0f;
    if (!before && !(dot(way, w.xyz) > from.position.w + to.position.w)) return;
    bins[link] = (ushort)bin;
    form_factors[link] = is_flat
        ? angle / (from.area * from.normal.w * dot(sends, w.xyz) * w.w)
        : 1.0f / (square * w.w);
}
