// Rectangles of texels onto pages.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace clgi {

struct PackBox {
    int width, height;                  // texels
    int page = 0, column = 0, row = 0;  // of its first texel
};

// Places boxes so that each keeps `padding` texels around it to itself; those may lie beyond the
// edge of the page. Returns the number of pages, or 0 if the boxes do not fit on most_pages.
int pack(std::vector<PackBox>& boxes, int size, int padding, int most_pages);

}  // namespace clgi
