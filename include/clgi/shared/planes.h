// Planes of pixels: each plane holds one attribute of all pixels; planes follow each other.
//
// Planes of a buffer are `stride` values apart. In full storage every value is a float; in half
// storage (BuildOptions::storage) directions, colours and irradiance are half, and only positions
// and depth stay float: their planes take two rows of halves.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_PLANES_H
#define CLGI_SHARED_PLANES_H

#include "clgi/shared/gbuffer.h"

// Row of halves, each `stride` long, where a plane of a G-buffer or of points begins.
#define HALF_ROW(plane) ((plane) < GBUFFER_NORMAL ? 2 * (plane) : (plane) + GBUFFER_NORMAL)

// Whether a plane of a G-buffer or of points is half in half storage.
#define HALF_PLANE(plane) ((plane) >= GBUFFER_NORMAL && (plane) < GBUFFER_DEPTH)

// Rows of halves that a whole G-buffer takes.
enum { GBUFFER_HALF_ROWS = 20 };

#endif
