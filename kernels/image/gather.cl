// Irradiance at every point: I_s of the VPLs less I_n of the negative ones.
//
//   E(p) = sum_l Phi_l max(0, n_p.t) max(0, -n_l.t) / d^2 k(d, r_l),   t = l - p, d = |t|
//                                                              [Cochran07, section 3.2]
//
// k is 1/(pi d^2) far away and bounded by the VPL's disc near by (lights/disc.clh), so a point
// that touches a VPL stays finite, and no term exceeds the VPL's own radiosity.
//
// Work size    1D, one work-item for every CLGI_WIDTH points (rounded up); any local size
// Writes       its own points
// Cost         33 flops and one division a pair; 48 bytes a VPL stay in cache, 24 bytes a point
//              are read and 12 written once
// SPDX-License-Identifier: MIT
#include "lights/disc.clh"
#include "planes.clh"
#include "clgi/shared/image.h"
#include "clgi/shared/lights.h"

kernel void image_gather(
    const GatherParams           params,
    global const uint*           restrict point_count,  // [1]
    global const float*          restrict points,       // [POINT_PLANES][stride]
    global const Vpl*  restrict lights,       // [vpl_count]
    global const Vpl*  restrict negative,     // [negative_count]
    global float*                restrict irradiance)   // [IRRADIANCE_PLANES][stride] lux, exposed
{
    uint point = (uint)get_global_id(0) * CLGI_WIDTH;
    if (point >= min(point_count[0], params.stride)) return;

    uint stride = params.stride;
    floatp px = row_load(gbuffer_row(points, 0, stride), point);
    floatp py = row_load(gbuffer_row(points, 1, stride), point);
    floatp pz = row_load(gbuffer_row(points, 2, stride), point);
    // Away from the surface, since t below runs from light to point.
    floatp nx = -row_load(gbuffer_row(points, 3, stride), point);
    floatp ny = -row_load(gbuffer_row(points, 4, stride), point);
    floatp nz = -row_load(gbuffer_row(points, 5, stride), point);
    floatp zero = packet_zero;

    floatp red = zero, green = zero, blue = zero;
    // The negative VPLs first; what they sum to is taken from the sum of the others.
    for (int sign = 0; sign < 2; ++sign) {
        uint count = sign == 0 ? params.negative_count : params.vpl_count;
        global const Vpl* light = sign == 0 ? negative : lights;
        floatp sum_red = zero, sum_green = zero, sum_blue = zero;
        for (uint l = 0; l < count; ++l, ++light) {
            float4 position = light->position;
            float4 normal = light->normal;
            float4 flux = light->flux;
            floatp tx = px - packet_splat(position.x);
            floatp ty = py - packet_splat(position.y);
            floatp tz = pz - packet_splat(position.z);
            floatp square = packet_dot(tx, ty, tz, tx, ty, tz);
            floatp receive = packet_dot(nx, ny, nz, tx, ty, tz);
            floatp send = packet_dot(packet_splat(normal.x), packet_splat(normal.y),
                                     packet_splat(normal.z), tx, ty, tz);
            floatp factor = disc_kernel(packet_max(receive, zero) * packet_max(send, zero), square,
                                        packet_splat(position.w), packet_splat(normal.w));
            sum_red = fma(factor, packet_splat(flux.x), sum_red);
            sum_green = fma(factor, packet_splat(flux.y), sum_green);
            sum_blue = fma(factor, packet_splat(flux.z), sum_blue);
        }
        red = sum_red - red;
        green = sum_green - green;
        blue = sum_blue - blue;
    }
    row_store(red * (1.0f / CLGI_PI), irradiance_row(irradiance, 0, stride), point);
    row_store(green * (1.0f / CLGI_PI), irradiance_row(irradiance, 1, stride), point);
    row_store(blue * (1.0f / CLGI_PI), irradiance_row(irradiance, 2, stride), point);
}
