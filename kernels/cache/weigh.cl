// How much is in doubt at each place that was picked about the light that it sends.
//
//   worth = rho sqrt(spread + (CACHE_COARSE Y)^2 + bare^2)    rho: reflectance, Y: luminance of E there
//
//   bare = Y_most max(a - WEIGH_NEARER q, 0) / a
//                              [derived: error of a source, to be weighed by importance, Smits92]
//
// a: least of |d|^2 + CACHE_OFF^2 off^2 of the records that stand in, which are in the list of the
// surface's own way; q: least |d|^2 of all around, the first of each list of a leaf; Y_most: the
// largest luminance of E of these.
//
// spread is what the records there differ by (lookup.clh). The second part stands for change that
// none of them shows, because all lie on one side of it. The third is for surfaces on which no record
// stands, such as the back of a screen or the top of a wall: those that stand in face the same way but
// are far off, and of the light there nothing is known but what others around it have.
//
// Work size    1D, one work-item for every CLGI_WIDTH picks (rounded up); any local size
// Writes       its own worth, and the record that counts most there; CACHE_NONE where none does
// Cost         a look-up, and 30 records around, of some 50 flops and nine scattered reads each
// SPDX-License-Identifier: MIT
#include "cache/lookup.clh"

#define CACHE_COARSE 0.1f
#define WEIGH_NEARER 16.0f
#define WEIGH_AROUND 5u  // of each list

static floatp weigh_bare(const CacheTree* tree, global const uint* nodes, global const uint* lists,
                         global const float* records, global const float* light, CacheVector point,
                         CacheVector normal) {
    floatp zero = packet_zero, standing = packet_splat(1e30f), nearest = standing, most = zero;
    intp first = cache_lists_at(tree, nodes, point), own = cache_way(normal);
    for (uint way = 0; way < CACHE_WAYS; ++way)
        for (uint k = 0; k < WEIGH_AROUND; ++k) {
            int index[CLGI_WIDTH], record[CLGI_WIDTH];
            packet_store(first + (int)(way * CACHE_LISTED + k), index);
            intp of = as_intp((uintp)(packet_lookup(lists, index)));
            intp listed = of != (int)CACHE_NONE;
            if (!packet_any(listed)) break;
            packet_store(packet_select((intp)(0), of, listed), record);
            CacheVector d = cache_row(records, tree->stride, record);
            CacheVector n = cache_row(records + RECORD_NORMAL * tree->stride, tree->stride, record);
            d.x -= point.x;
            d.y -= point.y;
            d.z -= point.z;
            floatp square = cache_dot(d, d);
            floatp off = CACHE_OFF * (fabs(cache_dot(n, d)) + fabs(cache_dot(normal, d)));
            intp stands = listed & (own == (int)way) & (cache_dot(n, normal) > CACHE_FACING);
            nearest = packet_select(nearest, packet_min(nearest, square), listed);
            standing =
                packet_select(standing, packet_min(standing, fma(off, off, square)), stands);
            CacheVector e = cache_row(light, tree->stride, record);
            most = packet_select(most, packet_max(most, luminance(e.x, e.y, e.z)), listed);
        }
    floatp farther = packet_max(fma(-WEIGH_NEARER, nearest, standing), zero);
    return most * (farther / packet_max(standing, packet_splat(1e-30f)));  // 0 on a record itself
}

kernel void cache_weigh(
    const CacheParams    params,
    const CacheTree      tree,
    global const uint*   restrict nodes,
    global const uint*   restrict lists,
    global const float*  restrict records,  // [RECORD_PLANES][tree.stride]
    global const float*  restrict light,    // [3][tree.stride] exposed lux
    global const float*  restrict places,   // [PICK_PLANES][pick_stride]
    global float*        restrict worth,    // [pick_stride] exposed lux
    global uint*         restrict nearest)  // [pick_stride]
{
    uint item = (uint)get_global_id(0) * CLGI_WIDTH;
    if (item >= params.count * params.picks) return;
    uint stride = params.pick_stride;
    CacheVector point, normal;
    packet_load3(places + item, stride, &point.x, &point.y, &point.z);
    packet_load3(places + RECORD_NORMAL * stride + item, stride, &normal.x, &normal.y, &normal.z);
    CacheShare share;
    cache_lookup(&tree, nodes, lists, records, point, normal, CACHE_LISTED, &share, 0);
    CacheVector there = cache_light(&share, light, tree.stride);
    floatp change = CACHE_COARSE * luminance(there.x, there.y, there.z), most = packet_zero;
    floatp spread = cache_spread(&share, light, tree.stride, there);
    intp record = (intp)((int)CACHE_NONE);
    for (uint i = 0; i < share.count; ++i) {
        intp more = share.weight[i] > most;
        most = packet_select(most, share.weight[i], more);
        record = packet_select(record, packet_load(share.record[i]), more);
    }
    floatp bare = weigh_bare(&tree, nodes, lists, records, light, point, normal);
    spread = fma(bare, bare, spread);
    floatp reflectance = packet_load(places + PICK_REFLECTANCE * stride + item);
    packet_store(reflectance * sqrt(fma(change, change, spread)), worth + item);
    packet_store(as_uintp(record), nearest + item);
}
