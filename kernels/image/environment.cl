// The background: what the environment sends along the rays that meet nothing.
//
//   L = mean over n x n points of the pixel's share of L(u, v),  n = 1 to 4, four points a texel
//   u = atan2(x, -z) / 2 pi + 1/2 + turn,  v = atan2(|(x, z)|, y) / pi
//                                            [derived: Environment in clgi/scene.hpp]
//
// Work size    1D, one work-item for every CLGI_WIDTH pixels (rounded up); any local size
// Writes       radiance of those of its own pixels in which nothing is; the others stay
//
// Nothing is where no normal is, as image/combine has it: a G-buffer from elsewhere may have no ids.
// SPDX-License-Identifier: MIT
#include "gbuffer/window.clh"
#include "planes.clh"
#include "clgi/shared/image.h"

#define ENVIRONMENT_POINTS 4  // at most, across and down, and so many a texel

// Where in the texels the ray through a point of the view's window ends.
static intp environment_texel(const EnvironmentParams* params, const View* view, floatp right,
                              floatp up) {
    floatp x = fma(right, packet_splat(view->right.x), up * view->up.x) + view->forward.x;
    floatp y = fma(right, packet_splat(view->right.y), up * view->up.y) + view->forward.y;
    floatp z = fma(right, packet_splat(view->right.z), up * view->up.z) + view->forward.z;
    floatp u = atan2(x, -z) * (0.5f / CLGI_PI) + (0.5f + params->turn);
    floatp v = atan2(sqrt(x * x + z * z), y) * (1.0f / CLGI_PI);
    u -= floor(u);
    int width = (int)params->environment_width, height = (int)params->environment_height;
    intp column = min(packet_int(u * (float)width), (intp)(width - 1));
    intp line = min(packet_int(v * (float)height), (intp)(height - 1));
    return 3 * (line * width + column);
}

kernel void image_environment(
    const EnvironmentParams  params,
    const View               view,
    global const float*      restrict texels,    // [environment_height][environment_width][3]
    global const float*      restrict planes,    // [GBUFFER_PLANES][stride]
    global float*            restrict radiance)  // [RADIANCE_PLANES][stride] cd/m^2
{
    uint pixel = (uint)get_global_id(0) * CLGI_WIDTH;
    if (pixel >= view.width * view.height) return;
    floatp nx = row_load(gbuffer_row(planes, GBUFFER_NORMAL, params.stride), pixel);
    floatp ny = row_load(gbuffer_row(planes, GBUFFER_NORMAL + 1, params.stride), pixel);
    floatp nz = row_load(gbuffer_row(planes, GBUFFER_NORMAL + 2, params.stride), pixel);
    intp nothing = !(packet_dot(nx, ny, nz, nx, ny, nz) > 0.0f);
    if (!packet_any(nothing)) return;

    floatp right, up, light[3] = {packet_zero, packet_zero, packet_zero};
    gbuffer_window(&view, pixel, &right, &up);
    // A sample of several has the share window.w of the pixel; a picture of one has it all.
    float side = view.window.w > 0.0f ? sqrt(view.window.w) : 1.0f;
    if (view.eye.w != 0.0f) {  // orthographic: all rays are parallel
        right = up = packet_zero;
        side = 0.0f;
    }
    float wide = side * 2.0f * view.right.w / (float)view.width;
    float high = side * 2.0f * view.up.w / (float)view.height;
    float texels_wide = fmax(wide, high) * (0.5f / CLGI_PI) * (float)params.environment_width;
    int n = clamp((int)ceil(ENVIRONMENT_POINTS * texels_wide), 1, ENVIRONMENT_POINTS);
    float step = 1.0f / (float)n, middle = 0.5f * (float)(n - 1);
    for (int point = 0; point < n * n; ++point) {
        floatp across = right + ((float)(point % n) - middle) * step * wide;
        floatp upward = up + ((float)(point / n) - middle) * step * high;
        int first[CLGI_WIDTH];
        packet_store(environment_texel(&params, &view, across, upward), first);
        for (int c = 0; c < 3; ++c) light[c] += (floatp)(packet_lookup(texels + c, first));
    }
    float share = step * step;
    float factor[3] = {share * params.factor.x, share * params.factor.y, share * params.factor.z};
    for (int c = 0; c < RADIANCE_PLANES; ++c) {
        global float* out = radiance + c * params.stride + pixel;
        packet_store(packet_select(packet_load(out), light[c] * factor[c], nothing), out);
    }
}
