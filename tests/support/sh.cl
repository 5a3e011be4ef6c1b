// The basis of packets of directions, term by term.
// SPDX-License-Identifier: MIT
#include "transfer/sh.clh"

kernel void sh(
    const uint            stride,
    global const float*   restrict directions,  // [3][stride]
    global float*         restrict values)      // [terms][stride]
{
    uint at = (uint)get_global_id(0) * CLGI_WIDTH;
    floatp x, y, z, out[SH_TERMS];
    packet_load3(directions + at, stride, &x, &y, &z);
    sh_evaluate(x, y, z, out);
    for (int term = 0; term < SH_TERMS; ++term)
        packet_store(out[term], values + term * stride + at);
}
