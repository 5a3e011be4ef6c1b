// Bins and form factors of links of which an end moved.
//                             [Dachsbacher07, sections 3.1 and 3.3, Eq. 17; derived: as make_links()]
//
// The bin is the one nearest to the way from the sender's part to the receiver among those that go
// off the side of a flat sender that faces it, and to the front of a flat receiver. A flat sender
// counts with the exact solid angle of its part [Van Oosterom, Strackee: The Solid Angle of a Plane
// Triangle. IEEE Transactions on Biomedical Engineering 30, 1983], the triple product written as
// twice the area times the height: that of three nearly equal unit vectors would lose bits.
//
// Work size    1D, one work-item a packet of moving links; any local size; tail guarded
// Writes       bins and form factors of its links; both are 0 where no light arrives
// Cost         3 CLGI_BINS / 2 multiply-adds; 9 CLGI_BINS more where the nearest bin does not serve
// SPDX-License-Identifier: MIT
#include "clgi/shared/antiradiance.h"
#include "clgi/shared/moving_elements.h"
#include "antiradiance/triangle.clh"
#include "packet.clh"

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

// The bins nearest to directions: opposite bins are one test.
CLGI_INLINE void nearest_bins(floatp x, floatp y, floatp z, global const float4* directions,
                              uint* nearest) {
    floatp most = packet_splat(-1.0f);
    intp best = (intp)(0), opposite = (intp)(0);
    for (int bin = 0; bin < CLGI_BINS / 2; ++bin) {
        float4 w = directions[bin];
        floatp along = packet_dot(packet_splat(w.x), packet_splat(w.y), packet_splat(w.z), x, y, z);
        intp further = fabs(along) > most;
        most = packet_select(most, fabs(along), further);
        best = packet_select(best, (intp)(bin), further);
        opposite = packet_select(opposite, along < packet_zero, further);
    }
    best = packet_select(best, best + CLGI_BINS / 2, opposite);
    int bins[CLGI_WIDTH];
    packet_store(best, bins);
    for (int k = 0; k < CLGI_WIDTH; ++k) nearest[k] = (uint)bins[k];
}

// A pair of elements on whose link light travels.
typedef struct {
    float3 along;            // unit: from the sender's part to the receiver
    float3 way;              // from the sender
    float3 sends, receives;  // normals that demand something of the bin
    float reach;             // of both
    float before;            // the receiver lies in front of the sender
    float share;             // of a bin's form factor: 1 / (area of the sender, sr)
} Aim;

// The bin of a link, if there is one within twice their spacing; CLGI_BINS: none.
CLGI_INLINE uint choose_bin(Aim aim, uint nearest, float least_cosine,
                            global const float4* directions) {
    float3 w = directions[nearest].xyz;
    if (is_met(aim.sends, LEAST_SENT, w) && is_met(aim.receives, LEAST_RECEIVED, w)) return nearest;
    uint best = CLGI_BINS;
    float most = least_cosine;
    for (uint bin = 0; bin < CLGI_BINS; ++bin) {
        w = directions[bin].xyz;
        float along = dot(w, aim.along);
        if (along > most && is_met(aim.sends, LEAST_SENT, w) &&
            is_met(aim.receives, LEAST_RECEIVED, w)) {
            most = along;
            best = bin;
        }
    }
    return best;
}

// Corners of a part as weights of the triangle's second and vertex patch corner.
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
    float side = twice_area_height / a / b / c, below = 1.0f + dot(u, v) + dot(v, w) + dot(w, u);
    // Most parts are small: the series is exact to a few bits of float there, and much quicker.
    float t = side / below, s = t * t;
    if (below > 0.0f && s < 0.015625f)
        return 2.0f * t * (1.0f - s * (1.0f / 3.0f - s * (0.2f - s * (1.0f / 7.0f))));
    return 2.0f * atan2(side, below);
}

// The centre of a part of a patch, and its solid angle from `eye`. height: of the eye above it.
CLGI_INLINE float3 part_of(PatchCorners patch, Triangle whole, uint part, float area, float height,
                           float3 eye, float* angle) {
    float2 corners[3] = {patch.weights.xy, patch.weights.zw, patch.last.xy};
    if (part >= PART_QUARTERS) {
        cut(corners, part < PART_SIXTEENTHS ? part - PART_QUARTERS : (part - PART_SIXTEENTHS) / 4);
        area *= 0.25f;
    }
    if (part >= PART_SIXTEENTHS) {
        cut(corners, (part - PART_SIXTEENTHS) % 4);
        area *= 0.25f;
    }
    float3 to[3], sum = (float3)(0.0f);
    for (int k = 0; k < 3; ++k) {
        to[k] = point_at(whole, corners[k]) - eye;
        sum += to[k];
    }
    *angle = solid_angle(to, 2.0f * area * fabs(height));
    return fma((float3)(1.0f / 3.0f), sum, eye);
}

// 0: no light arrives.
CLGI_INLINE int aim_at(ElementPlace from, ElementPlace to, uint part, PatchCorners patch,
                       global const uint4* triangles, global const float4* positions, Aim* out) {
    int is_patch = from.triangle != ELEMENT_NONE, is_flat = !is_zero(from.normal.xyz);
    float3 start = from.position.xyz;
    out->way = to.position.xyz - start;
    out->receives = -to.normal.xyz;
    out->sends = (float3)(0.0f);
    out->reach = from.position.w + to.position.w;
    out->before = 0.0f;
    float square = dot(out->way, out->way);
    if (!(square > 0.0f) || (is_patch && !is_flat)) return 0;
    out->share = 1.0f / square;
    if (is_flat) {
        float height = dot(from.normal.xyz, out->way);
        if (!(fabs(height) > LEAST_HEIGHT)) return 0;
        out->before = height;
        out->sends = height > 0.0f ? from.normal.xyz : -from.normal.xyz;
        // What came nearer than in all poses is no larger than half of the sphere.
        float angle = fmin(from.area * fabs(height) / (square * sqrt(square)), 2.0f * CLGI_PI);
        if (is_patch)
            start = part_of(patch, triangle_of(triangles[from.triangle], positions), part,
                            from.area, height, to.position.xyz, &angle);
        out->share = angle / (from.area * from.normal.w);
    }
    float3 along = to.position.xyz - start;
    float distance = length(along);
    if (!(out->share > 0.0f && distance > 0.0f)) return 0;
    out->along = along / distance;
    return is_met(out->receives, LEAST_HEIGHT, along);
}

kernel void antiradiance_relink(
    const RelinkParams         params,
    global const uint2*        restrict links,         // [count] moving links
    global const ElementPlace* restrict places,        // [elements]
    global const PatchCorners* restrict patches,       // [elements]
    global const uint4*        restrict triangles,     // of the scene
    global const float4*       restrict positions,     // of its vertices, local frame
    global const float4*       restrict directions,    // [CLGI_BINS] unit; w: sr
    global const uint*         restrict senders,       // [count] of moving links
    global ushort*             restrict bins,
    global float*              restrict form_factors)  // 2^row_exponent / (area of the local
                                                       // frame, sr)
{
    uint first = (uint)get_global_id(0) * CLGI_WIDTH;
    Aim aims[CLGI_WIDTH];
    float x[CLGI_WIDTH], y[CLGI_WIDTH], z[CLGI_WIDTH];
    int open[CLGI_WIDTH], any_open = 0;
    for (uint k = 0; k < CLGI_WIDTH; ++k) {
        open[k] = 0;
        x[k] = y[k] = z[k] = 0.0f;
        if (first + k >= params.count) continue;
        uint2 link = links[first + k];
        uint sender = senders[first + k];
        bins[link.x] = 0;
        form_factors[link.x] = 0.0f;
        open[k] = aim_at(places[sender], places[link.y & ((1u << PART_SHIFT) - 1u)],
                         link.y >> PART_SHIFT, patches[sender], triangles, positions, aims + k);
        if (!open[k]) continue;
        any_open = 1;
        x[k] = aims[k].along.x;
        y[k] = aims[k].along.y;
        z[k] = aims[k].along.z;
    }
    if (!any_open) return;
    uint nearest[CLGI_WIDTH];
    nearest_bins(packet_load(x), packet_load(y), packet_load(z), directions, nearest);
    for (uint k = 0; k < CLGI_WIDTH; ++k) {
        if (!open[k]) continue;
        Aim aim = aims[k];
        uint bin = choose_bin(aim, nearest[k], params.least_cosine, directions);
        if (bin == CLGI_BINS) continue;
        // Light that was let through comes from behind to what lies further along the bin, or it
        // could go round in a bin for ever.
        float4 w = directions[bin];
        if (!(aim.before > 0.0f) && !(dot(aim.way, w.xyz) > aim.reach)) continue;
        float cosine = is_zero(aim.sends) ? 1.0f : dot(aim.sends, w.xyz);
        bins[links[first + k].x] = (ushort)bin;
        // Times 2^row_exponent, by bits: exact in every kind of math.
        float unit = as_float((uint)(places[senders[first + k]].row_exponent + 127) << 23);
        form_factors[links[first + k].x] = aim.share / (cosine * w.w) * unit;
    }
}
