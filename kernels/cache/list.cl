// The records nearest to the middle of a leaf of the tree, for each of the ways that a surface can face.
//
//   |d|^2 + 16 max(off - LIST_WITHIN h, 0)^2       d: from a record to the middle, h: half the leaf's side
//
// off: from the record's plane. A surface within the leaf may lie on the plane although its middle does
// not. Of equals the first record comes first. The crowd that the leaf lies in is looked at first, and
// then those whose boxes are not farther than what was found.                [derived: nearest boxes]
//
// Work size    1D, one work-item a leaf and way; any local size; tail guarded
// Writes       its own list, CACHE_NONE after its last record
// SPDX-License-Identifier: MIT
#include "clgi/shared/cache.h"
#include "packet.clh"

// A record is listed where it can stand in for a surface that faces a way: cosine with the axis. A
// surface whose main axis that is has a cosine of 0.577 at least.
#define LIST_FACING 0.1f
#define LIST_WITHIN 1.7f
#define LIST_OFF 16.0f
#define LIST_ROUNDED 0.99999f  // squares of distances

// From the nearest on, in as many lanes as a list has places.
typedef struct {
    float16 away;
    uint16 record;
} NearestRecords;

#define LIST_MOVED(first, v) (first, (v).s01234567, (v).s89ab, (v).scd, (v).se)

// One more: what is farther moves up by a place, and the last one leaves.
CLGI_INLINE void list_insert(NearestRecords* list, float away, uint record) {
    int16 farther = (list->away > away) | ((list->away == away) & (list->record > record));
    int16 all = (int16)LIST_MOVED(0, farther);  // also what lies before it
    float16 moved = select((float16)(away), (float16)LIST_MOVED(away, list->away), all);
    uint16 with = select((uint16)(record), (uint16)LIST_MOVED(record, list->record), all);
    list->away = select(list->away, moved, farther);
    list->record = select(list->record, with, farther);
}

// Those of a crowd. Past the last record normals are 0.
static void list_crowd(const CacheListParams* params, float4 leaf, uint way, uint crowd,
                       global const float* records, global const uint* order, NearestRecords* list) {
    global const float* normals = records + RECORD_NORMAL * params->stride;
    for (uint k = 0; k < CACHE_CROWD; k += CLGI_WIDTH) {
        uint first = crowd * CACHE_CROWD + k;
        floatp along = packet_load(normals + way / 2 * params->stride + first);
        intp nearer = (way % 2 == 0 ? along : -along) > LIST_FACING;
        if (!packet_any(nearer)) continue;
        floatp x, y, z, nx, ny, nz;
        packet_load3(records + first, params->stride, &x, &y, &z);
        packet_load3(normals + first, params->stride, &nx, &ny, &nz);
        x = leaf.x - x;
        y = leaf.y - y;
        z = leaf.z - z;
        floatp within = packet_splat(LIST_WITHIN * leaf.w);
        floatp off = packet_max(fabs(packet_dot(x, y, z, nx, ny, nz)) - within, packet_zero);
        floatp away = fma(LIST_OFF * off, off, packet_dot(x, y, z, x, y, z));
        nearer &= away <= list->away.sf;
        if (!packet_any(nearer)) continue;
        float lane[CLGI_WIDTH];
        packet_store(away, lane);
        for (ulong set = packet_set(nearer); set;) {
            uint n = packet_first(set);
            set = packet_without(set, n);
            list_insert(list, lane[n], order[first + n]);
        }
    }
}

// Which of CLGI_WIDTH crowds have a box that is not farther than the last of the list.
CLGI_INLINE intp list_boxes(const CacheListParams* params, float4 leaf, uint first,
                            global const float* boxes, float farthest) {
    float middle[3] = {leaf.x, leaf.y, leaf.z};
    floatp square = packet_zero;
    for (uint axis = 0; axis < 3; ++axis) {
        floatp low = packet_load(boxes + axis * params->crowd_stride + first);
        floatp high = packet_load(boxes + (3 + axis) * params->crowd_stride + first);
        floatp off = packet_max(packet_max(low - middle[axis], middle[axis] - high), packet_zero);
        square = fma(off, off, square);
    }
    return LIST_ROUNDED * square <= farthest;
}

kernel void cache_list(
    const CacheListParams    params,
    global const CacheLeaf*  restrict leaves,   // [leaf_count]
    global const float*      restrict records,  // [6][stride] positions and normals
    global const uint*       restrict order,    // [stride] which records these are
    global const float*      restrict boxes,    // [6][crowd_stride] low and high corners
    global uint*             restrict lists)    // [leaf_count][CACHE_WAYS][CACHE_LISTED]
{
    uint item = (uint)get_global_id(0), way = item % CACHE_WAYS;
    if (item >= params.leaf_count * CACHE_WAYS) return;
    float4 leaf = leaves[item / CACHE_WAYS].cube;
    NearestRecords list;
    list.away = (float16)(FLT_MAX);
    list.record = (uint16)(CACHE_NONE);
    uint crowds = (params.record_count + CACHE_CROWD - 1) / CACHE_CROWD;
    uint own = min(leaves[item / CACHE_WAYS].before / CACHE_CROWD, crowds - 1);
    list_crowd(&params, leaf, way, own, records, order, &list);
    for (uint first = 0; first < crowds; first += CLGI_WIDTH) {
        ulong set = packet_set(list_boxes(&params, leaf, first, boxes, list.away.sf));
        while (set) {
            uint n = packet_first(set), crowd = first + n;
            set = packet_without(set, n);
            if (crowd < crowds && crowd != own)
                list_crowd(&params, leaf, way, crowd, records, order, &list);
        }
    }
    vstore16(list.record, item, lists);
}
