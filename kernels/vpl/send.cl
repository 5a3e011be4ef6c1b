// What the sites send to the texels, shared out among their sample points.
//
//   P = rho A I,   p_k = P q_k / sum_l q_l,   q_k = rho_k max(E_k + I - E, 0)
//
// E_k: direct irradiance of the sample, E: its mean, I: all irradiance of the site. What arrives by
// reflection is taken for even over the site; direct light has edges, which show near by.
//                                                       [derived: refined near field, exchange.clh]
//
// Sent is the difference to what was sent before. A site whose samples' powers changed by no more
// than `least` together sends nothing, and its change stays for another time. Light that moves
// within a site is a change too.                                          [Schaerfig16, section 6.2]
//
// Work size    1D, one work-item a site; any local size; tail guarded
// Writes       its own flag and powers, those of its samples, and what they sent in all
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/vpl.h"
#include "packet.clh"

kernel void vpl_send(
    const SendParams     params,
    global const Site*   restrict sites,         // [site_count]
    global const float*  restrict planes,        // [SITE_PLANES][stride]
    global const float*  restrict irradiance,    // [IRRADIANCE_PLANES][sample_stride] lux, exposed
    global const float*  restrict light,         // [SITE_LIGHT_PLANES][stride]
    global const float*  restrict samples,       // [GBUFFER_PLANES][sample_stride]
    global float*        restrict sent,          // [3][sample_stride] exposed lumen
    global float*        restrict sample_power,  // [3][sample_stride] exposed lumen
    global float*        restrict site_power,    // [3][stride] sum of its samples
    global uchar*        restrict sends)         // [site_count] 1: the site sends something
{
    uint site = (uint)get_global_id(0);
    if (site >= params.site_count) return;
    Site own = sites[site];
    uint last = own.first_sample + own.sample_count;
    float count = (float)own.sample_count;
    float change = 0.0f;
    for (uint c = 0; c < 3; ++c) {
        global const float* direct = irradiance + c * params.sample_stride;
        global const float* albedo = samples + (GBUFFER_BASE + c) * params.sample_stride;
        global const float* before = sent + c * params.sample_stride;
        global float* powers = sample_power + c * params.sample_stride;
        float received = light[(SITE_RECEIVED + c) * params.stride + site];
        float power = planes[(SITE_ALBEDO + c) * params.stride + site] * own.area * received;
        float mean = 0.0f;
        for (uint k = own.first_sample; k < last; ++k) mean += direct[k];
        float reflected = received - mean / count;
        float sum = 0.0f;
        for (uint k = own.first_sample; k < last; ++k) {
            float value = albedo[k] * max(direct[k] + reflected, 0.0f);
            powers[k] = value;
            sum += value;
        }
        // Light too dark or too bright to divide by, or no number at all, is shared evenly. The product
        // of two such numbers has to be one too: fast math may multiply before it divides.
        int usable = sum > 1e-12f && sum < 1e12f;
        for (uint k = own.first_sample; k < last; ++k) {
            powers[k] = usable ? powers[k] * (power / sum) : power / count;
            change += fabs(powers[k] - before[k]);
        }
    }
    // What is no number is worth it too: by bits, since fast math takes every number for finite.
    int worth = change > params.least || (int)(as_uint(change) & 0x7fffffffu) >= NOT_FINITE;
    sends[site] = (uchar)worth;
    for (uint c = 0; c < 3; ++c) {
        float sum = 0.0f;
        for (uint k = own.first_sample; k < last; ++k) {
            uint at = c * params.sample_stride + k;
            float power = sample_power[at];
            sample_power[at] = worth ? power - sent[at] : 0.0f;
            if (worth) sent[at] = power;
            sum += sample_power[at];
        }
        site_power[c * params.stride + site] = sum;
    }
}
