// The background: what the environment sends along the rays that meet nothing.
//
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

    floatp right, up;
    gbuffer_window(&view, pixel, &right, &up);
    if (view.eye.w != 0.0f) right = up = packet_zero;  // orthographic: all rays are parallel
    floatp x = fma(right, packet_splat(view.right.x), up * view.up.x) + view.forward.x;
    floatp y = fma(right, packet_splat(view.right.y), up * view.up.y) + view.forward.y;
    floatp z = fma(right, packet_splat(view.right.z), up * view.up.z) + view.forward.z;

    floatp u = atan2(x, -z) * (0.5f / CLGI_PI) + (0.5f + params.turn);
    floatp v = atan2(sqrt(x * x + z * z), y) * (1.0f / CLGI_PI);
    u -= floor(u);
    int most_x = (int)params.environment_width - 1;
    int most_y = (int)params.environment_height - 1;
    intp texel_x = min(packet_int(u * (float)params.environment_width), (intp)(most_x));
    intp texel_y = min(packet_int(v * (float)params.environment_height), (intp)(most_y));
    int first[CLGI_WIDTH];
    packet_store(3 * (texel_y * (int)params.environment_width + texel_x), first);
    float factor[3] = {params.factor.x, params.factor.y, params.factor.z};
    for (int c = 0; c < RADIANCE_PLANES; ++c) {
        global float* out = radiance + c * params.stride + pixel;
        floatp sent = (floatp)(packet_lookup(texels + c, first));
        packet_store(packet_select(packet_load(out), sent * factor[c], nothing), out);
    }
}
