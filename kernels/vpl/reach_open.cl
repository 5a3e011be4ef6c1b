// The share of each shooter's hemisphere, weighted with the cosine, in which it meets the front of a
// surface, where nothing lies between surfaces: the sum of the form factors of all triangles.
//
//   F = 1/(2 pi) | sum over edges of theta n.(u x v) / |u x v| |,   theta: angle from u to v
//                                        [Lambert 1760; Baum, Rushmeier, Winget 1989, Eq. 8]
//
// of the part of a triangle above the horizon. theta / sin theta is a polynomial of cos theta for
// angles up to a right one, and pi / sin theta less that of the other way beyond.
//                                            [derived: Chebyshev, degree 8, relative error 8e-8]
//
// Holes of alpha masks count as surface. What is more than all is all.
//
// Work size    1D, one work-item for every CLGI_WIDTH shooters; any local size; tail guarded
// Writes       its own shares
// Cost         some 300 flops a pair of shooter and triangle
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/scene.h"
#include "clgi/shared/vpl.h"
#include "packet.clh"

typedef struct {
    floatp x, y, z;
} Ray;

CLGI_INLINE floatp reach_dot(Ray a, Ray b) {
    return packet_dot(a.x, a.y, a.z, b.x, b.y, b.z);
}

CLGI_INLINE Ray reach_select(Ray otherwise, Ray value, intp mask) {
    Ray out = {packet_select(otherwise.x, value.x, mask), packet_select(otherwise.y, value.y, mask),
               packet_select(otherwise.z, value.z, mask)};
    return out;
}

// theta n.(a x b) / |a x b|; 0 for edges without a direction.
CLGI_INLINE floatp reach_edge(Ray a, Ray b, Ray n) {
    Ray c = {fma(a.y, b.z, -a.z * b.y), fma(a.z, b.x, -a.x * b.z), fma(a.x, b.y, -a.y * b.x)};
    floatp one = packet_splat(1.0f);
    floatp lengths = sqrt(reach_dot(a, a) * reach_dot(b, b));
    lengths = packet_select(one, lengths, lengths > 0.0f);
    floatp cosine = reach_dot(a, b) / lengths, sine = sqrt(reach_dot(c, c)) / lengths;
    floatp x = packet_min(fabs(cosine), one);
    floatp ratio = packet_splat(0.017185369f);
    ratio = fma(ratio, x, packet_splat(-0.096076305f));
    ratio = fma(ratio, x, packet_splat(0.25012653f));
    ratio = fma(ratio, x, packet_splat(-0.42189572f));
    ratio = fma(ratio, x, packet_splat(0.55574896f));
    ratio = fma(ratio, x, packet_splat(-0.66075862f));
    ratio = fma(ratio, x, packet_splat(0.78485381f));
    ratio = fma(ratio, x, packet_splat(-0.99998017f));
    ratio = fma(ratio, x, packet_splat(1.5707962f));
    floatp wide = packet_splat(CLGI_PI) / packet_select(one, sine, sine > 0.0f) - ratio;
    ratio = packet_select(ratio, wide, cosine < 0.0f);
    return packet_select(packet_zero, ratio * (reach_dot(n, c) / lengths), sine > 0.0f);
}

kernel void vpl_reach_open(
    const TransportParams  params,
    const uint             triangle_count,
    global const uint*     restrict chosen,     // [first_shooter + shooter_count] sites
    global const float*    restrict planes,     // [SITE_PLANES][stride]
    global const uint4*    restrict triangles,  // [triangle_count] three vertices, material
    global const float4*   restrict positions,  // [vertex_count] local frame
    global float*          restrict balance)    // [BALANCE_PLANES][stride]
{
    uint item = (uint)get_global_id(0) * CLGI_WIDTH;
    if (item >= params.shooter_count) return;
    uint site[CLGI_WIDTH];
    float row[6][CLGI_WIDTH];
    for (uint k = 0; k < CLGI_WIDTH; ++k) {
        uint there = min(item + k, params.shooter_count - 1);
        site[k] = chosen[params.first_shooter + there];
        for (uint c = 0; c < 6; ++c) row[c][k] = planes[c * params.stride + site[k]];
    }
    Ray n = {packet_load(row[3]), packet_load(row[4]), packet_load(row[5])};
    Ray eye = {fma(packet_splat(params.lift), n.x, packet_load(row[0])),
               fma(packet_splat(params.lift), n.y, packet_load(row[1])),
               fma(packet_splat(params.lift), n.z, packet_load(row[2]))};
    floatp all = packet_zero;
    for (uint t = 0; t < triangle_count; ++t) {
        uint4 word = triangles[t];
        float4 corner[3] = {positions[word.x], positions[word.y], positions[word.z]};
        float4 wound = cross(corner[1] - corner[0], corner[2] - corner[0]);
        Ray to[3];
        floatp above[3];
        for (int k = 0; k < 3; ++k) {
            to[k].x = packet_splat(corner[k].x) - eye.x;
            to[k].y = packet_splat(corner[k].y) - eye.y;
            to[k].z = packet_splat(corner[k].z) - eye.z;
            above[k] = reach_dot(to[k], n);
        }
        intp front = packet_dot(to[0].x, to[0].y, to[0].z, packet_splat(wound.x),
                                packet_splat(wound.y), packet_splat(wound.z)) < 0.0f;
        front |= (intp)((word.w & (uint)TRIANGLE_DOUBLE_SIDED) != 0 ? -1 : 0);
        intp there = front & ((above[0] > 0.0f) | (above[1] > 0.0f) | (above[2] > 0.0f));
        if (!packet_any(there)) continue;
        // Where the outline goes below the horizon, and where it comes back.
        Ray down = {packet_zero, packet_zero, packet_zero}, up = down;
        floatp sum = packet_zero;
        for (int k = 0; k < 3; ++k) {
            Ray a = to[k], b = to[(k + 1) % 3];
            floatp za = above[k], zb = above[(k + 1) % 3];
            intp a_up = za > 0.0f, b_up = zb > 0.0f;
            intp falls = a_up & ~b_up, rises = b_up & ~a_up;
            floatp part = za / packet_select(packet_splat(1.0f), za - zb, falls | rises);
            Ray cut = {fma(part, b.x - a.x, a.x), fma(part, b.y - a.y, a.y),
                       fma(part, b.z - a.z, a.z)};
            down = reach_select(down, cut, falls);
            up = reach_select(up, cut, rises);
            a = reach_select(a, cut, rises);
            b = reach_select(b, cut, falls);
            sum += packet_select(packet_zero, reach_edge(a, b, n), a_up | b_up);
        }
        sum += reach_edge(down, up, n);
        all += packet_select(packet_zero, fabs(sum), there);
    }
    all = packet_min(all * (0.5f / CLGI_PI), packet_splat(1.0f));
    float lane[CLGI_WIDTH];
    packet_store(all, lane);
    for (uint k = 0; k < CLGI_WIDTH && item + k < params.shooter_count; ++k)
        balance[BALANCE_REACH * params.stride + site[k]] = lane[k];
}
