// Light that arrives at glossy leaves, and what leaves them: as antiradiance.local, and what their
// lobes make of every bin for every other.       [Dachsbacher07, Eq. 13, 14, 16, 18 and 19]
//
//   I_ex(j) = a c_j (source(j) + L + k sum over l of f(l, j) omega_l (-c_l) L_in(l)),   c_j > 0
//
// with L of the diffuse part, k the lobe's colour, f of antiradiance.lobes: of the light of a bin no
// more leaves than the lobe's albedo.
//
// Work size    1D, one work-item a glossy leaf; any local size; tail guarded
// Writes       of its leaves: what antiradiance.local does, and the radiance that arrived in front.
//              Numbers that are not finite stay so and are counted
// Cost         that of antiradiance.local; for a pair of bins above the surface 17 multiply-adds, 6
//              other operations on floats and 12 on integers: a quarter of CLGI_BINS squared pairs
// SPDX-License-Identifier: MIT
#include "antiradiance/glossy.clh"
#include "antiradiance/leaf.clh"

// Red, green and blue of the bins above a surface.
typedef struct {
    float channel[3][FRONT_BINS];
} FrontLight;

// What the lobe makes of the light, without `out` and the lobe's colour.
CLGI_INLINE void convolve(const Front* front, float exponent, const FrontLight* light,
                          FrontLight* made) {
    for (uint j = 0; j < FRONT_BINS; j += CLGI_WIDTH) {
        floatp x = packet_load(front->x + j), y = packet_load(front->y + j),
               z = packet_load(front->z + j);
        floatp red = packet_zero, green = packet_zero, blue = packet_zero;
        for (uint l = 0; l < HALF_BINS; ++l) {
            floatp share =
                lobe_toward(x, y, z, front->mx[l], front->my[l], front->mz[l], exponent);
            red = fma(share, packet_splat(light->channel[0][l]), red);
            green = fma(share, packet_splat(light->channel[1][l]), green);
            blue = fma(share, packet_splat(light->channel[2][l]), blue);
        }
        packet_store(red, made->channel[0] + j);
        packet_store(green, made->channel[1] + j);
        packet_store(blue, made->channel[2] + j);
    }
}

kernel void antiradiance_gloss(GLOSS_ARGUMENTS) {
    uint at = (uint)get_global_id(0);
    if (at >= params.count) return;
    uint element = glossy[at].element;
    Element leaf = elements[element];
    LinkedElements of = LINKS;
    Bins4 row[CLGI_FOURS], sent[CLGI_FOURS];
    const float4* arrives = (const float4*)row;
    float4* leaves = (float4*)sent;
    receive_at_leaf(element, of, incident, params.step, row);
    float4 arrived = irradiance_of(leaf, directions, row);
    note_irradiance(leaf, arrived, irradiances, changes);
    float4 radiance =
        reflect_diffuse(leaf, params.step, arrived, sources, reflectances, radiances);
    float area = leaf.normal.w * power_of_two(-leaf.row_exponent);

    next_powers[element] = (float4)(0.0f);
    bool sends = leaf.sends != ELEMENT_NONE;
    ulong first = sends ? (ulong)leaf.sends * CLGI_BINS : 0;
    global float* shown = arriving + (ulong)at * 3 * ROW_BINS;
    for (uint bin = 0; bin < CLGI_BINS; ++bin) {
        float cosine = dot(leaf.normal.xyz, directions[bin].xyz);
        float4 in = cosine < 0.0f ? arrives[bin] : (float4)(0.0f);
        shown[bin] = in.x;
        shown[ROW_BINS + bin] = in.y;
        shown[2 * ROW_BINS + bin] = in.z;
        // Bins above the surface are done below, or stay as they were.
        leaves[bin] = (float4)(0.0f);
        if (params.step & LOCAL_GO_THROUGH && cosine <= 0.0f)
            leaves[bin] = cosine * area * arrives[bin];
        else if (sends)
            leaves[bin] = load_intensity(exitant, first + bin);
    }
    float exponent = glossy[at].exponent;
    int good = is_finite3(arrived.xyz) && lobe_is_number(exponent);
    if (params.step & LOCAL_REFLECT) {
        Front front;
        find_front(leaf.normal.xyz, planes, &front);
        global const float* factor = factors + (ulong)at * CLGI_BINS;
        FrontLight light, made;
        for (uint k = 0; k < HALF_BINS; ++k) {
            uint from = bin_below(front.turned[k], k);
            float4 flux = factor[from] * front.projected[k] * arrives[from];
            light.channel[0][k] = flux.x;
            light.channel[1][k] = flux.y;
            light.channel[2][k] = flux.z;
        }
        if (params.step & LOCAL_RECEIVE)
            convolve(&front, lobe_exponent(exponent), &light, &made);
        else
            made = light;  // none of it, or what is no number
        global const float* source = gloss_sources + (ulong)at * 3 * ROW_BINS;
        for (uint k = 0; k < HALF_BINS; ++k) {
            uint bin = bin_above(front.turned[k], k);
            float4 made_here = (float4)(made.channel[0][k], made.channel[1][k],
                                        made.channel[2][k], 0.0f);
            float4 own = (float4)(source[bin], source[ROW_BINS + bin],
                                  source[2 * ROW_BINS + bin], 0.0f);
            float4 leaving = radiance + fma(colors[at] * factor[bin], made_here, own);
            if (!is_finite3(leaving.xyz)) good = 0;
            leaves[bin] = front.cosine[k] * area * leaving;
        }
    }
    for (uint four = 0; sends && four < CLGI_FOURS; ++four)
        store_intensities(sent[four], next, first / 4 + four);
    if (!good) atomic_inc(non_finite);
}
