// The one file that compiles stb_rect_pack.
// SPDX-License-Identifier: MIT
#include "methods/light_atlas/pack.hpp"

#include <algorithm>
#include <cstddef>

namespace {

// In place of qsort, which may order equal boxes differently on every machine.
template <typename T>
void sort_stably(T* first, int count, std::size_t /*size*/,
                 int (*compare)(const void*, const void*)) {
    std::stable_sort(first, first + count,
                     [compare](const T& a, const T& b) { return compare(&a, &b) < 0; });
}

}  // namespace

#define STBRP_STATIC
#define STBRP_SORT sort_stably
#define STB_RECT_PACK_IMPLEMENTATION
#include <stb_rect_pack.h>

namespace clgi {

int pack(std::vector<PackBox>& boxes, int size, int padding, int most_pages) {
    const int side = size + 2 * padding;
    double area = 0.0;
    for (const PackBox& box : boxes) {
        if (box.width > size || box.height > size) return 0;
        area += double(box.width + 2 * padding) * (box.height + 2 * padding);
    }
    if (area > double(side) * side * most_pages) return 0;  // cheaper than to try

    std::vector<stbrp_rect> rest(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        rest[i].id = static_cast<int>(i);
        rest[i].w = boxes[i].width + 2 * padding;
        rest[i].h = boxes[i].height + 2 * padding;
    }
    std::vector<stbrp_node> nodes(static_cast<std::size_t>(side));
    int page = 0;
    for (; !rest.empty() && page < most_pages; ++page) {
        stbrp_context context;
        stbrp_init_target(&context, side, side, nodes.data(), side);
        stbrp_pack_rects(&context, rest.data(), static_cast<int>(rest.size()));
        std::vector<stbrp_rect> left;
        for (const stbrp_rect& rect : rest) {
            if (!rect.was_packed) {
                left.push_back(rect);
                continue;
            }
            // The corner of the padding at -padding is the corner of the box at 0.
            PackBox& box = boxes[static_cast<std::size_t>(rect.id)];
            box.page = page;
            box.column = rect.x;
            box.row = rect.y;
        }
        rest = std::move(left);
    }
    return rest.empty() ? page : 0;
}

}  // namespace clgi
