// Tells the size of every shared struct and the place of every member, in the list's order.
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/image.h"
#include "clgi/shared/lights.h"
#include "clgi/shared/parallel.h"
#include "clgi/shared/scene.h"
#include "layout_members.h"

#define TELL_SIZE(type) found[next++] = (uint)sizeof(type);
#define TELL_MEMBER(type, member)                                       \
    {                                                                   \
        type value;                                                     \
        found[next++] = (uint)((char*)&value.member - (char*)&value);   \
    }

kernel void layout(global uint* restrict found)  // [entries of the list]
{
    uint next = 0;
    CLGI_LAYOUT(TELL_SIZE, TELL_MEMBER)
}
