// The records nearest to the middle of a leaf of the tree, for each of the ways that a surface can face.
//
//   |d|^2 + 16 max(off - LIST_WITHIN h, 0)^2       d: from a record to the middle, h: half the leaf's side
//
// off: from the record's plane. A surface within the leaf may lie on the plane although its middle does
// not. Of equals the first record comes first. The crowd that the leaf lies in is looked at first, and
// then those whose boxes are not farther than what was found, from its packet of crowds on.
//                                                                            [derived: nearest boxes]
//
// Work size    1D, one work-item a leaf; any local size; tail guarded
// Writes       its own lists, CACHE_NONE after the last record of each
// SPDX-License-Identifier: MIT
#include "clgi/shared/cache.h"
#include "packet.clh"

// A record is listed where it can stand in for a surface that faces a way: cosine with the axis. A
// surface whose main axis that is has a cosine of 0.577 at least.
#define LIST_FACING 0.1f
#define LIST_WITHIN 1.7f
#define LIST_OFF 16.0f
#define LIST_ROUNDED 0.99999f  // squares of distances
// Ways whose lists are filled in one go: on a GPU more would not fit in registers.
#if CLGI_WIDTH == 1
#define LIST_TOGETHER 1
#else
#define LIST_TOGETHER CACHE_WAYS
#endif

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

// Those of a crowd, for LIST_TOGETHER ways. Past the last record normals are 0.
static void list_crowd(const CacheListParams* params, float4 leaf, uint first_way, uint crowd,
                       global const float* records, global const uint* order, NearestRecords* lists) {
    floatp within = packet_splat(LIST_WITHIN * leaf.w);
    for (uint k = 0; k < CACHE_CROWD; k += CLGI_WIDTH) {
        uint first = crowd * CACHE_CROWD + k;
        floatp x, y, z, normal[3];
        packet_load3(records + first, params->stride, &x, &y, &z);
        packet_load3(records + RECORD_NORMAL * params->stride + first, params->stride, &normal[0],
                     &normal[1], &normal[2]);
        x = leaf.x - x;
        y = leaf.y - y;
        z = leaf.z - z;
        floatp off = fabs(packet_dot(x, y, z, normal[0], normal[1], normal[2]));
        off = packet_max(off - within, packet_zero);
        floatp away = fma(LIST_OFF * off, off, packet_dot(x, y, z, x, y, z));
        float lane[CLGI_WIDTH];
        packet_store(away, lane);
        #pragma unroll
        for (uint i = 0; i < LIST_TOGETHER; ++i) {
            uint way = first_way + i;
            floatp along = normal[way / 2];
            intp nearer = (way % 2 == 0 ? along : -along) > LIST_FACING;
            for (ulong set = packet_set(nearer & (away <= lists[i].away.sf)); set;) {
                uint n = packet_first(set);
                set = packet_without(set, n);
                list_insert(lists + i, lane[n], order[first + n]);
            }
        }
    }
}

// The last of the lists that has the farthest.
CLGI_INLINE float list_farthest(const NearestRecords* lists) {
    float out = 0.0f;
    #pragma unroll
    for (uint i = 0; i < LIST_TOGETHER; ++i) out = fmax(out, lists[i].away.sf);
    return out;
}

// Which of CLGI_WIDTH crowds have a box that is not farther than that.
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
    uint item = (uint)get_global_id(0);
    if (item >= params.leaf_count) return;
    float4 leaf = leaves[item].cube;
    uint crowds = (params.record_count + CACHE_CROWD - 1) / CACHE_CROWD;
    uint packets = (crowds + CLGI_WIDTH - 1) / CLGI_WIDTH;
    uint own = min(leaves[item].before / CACHE_CROWD, crowds - 1);
    for (uint way = 0; way < CACHE_WAYS; way += LIST_TOGETHER) {
        NearestRecords found[LIST_TOGETHER];
        for (uint i = 0; i < LIST_TOGETHER; ++i) {
            found[i].away = (float16)(FLT_MAX);
            found[i].record = (uint16)(CACHE_NONE);
        }
        list_crowd(&params, leaf, way, own, records, order, found);
        for (uint step = 0; step < packets; ++step) {
            uint first = (own / CLGI_WIDTH + step) % packets * CLGI_WIDTH;
            float farthest = list_farthest(found);
            ulong set = packet_set(list_boxes(&params, leaf, first, boxes, farthest));
            while (set) {
                uint n = packet_first(set), crowd = first + n;
                set = packet_without(set, n);
                if (crowd < crowds && crowd != own)
                    list_crowd(&params, leaf, way, crowd, records, order, found);
            }
        }
        for (uint i = 0; i < LIST_TOGETHER; ++i)
            vstore16(found[i].record, item * CACHE_WAYS + way + i, lists);
    }
}
