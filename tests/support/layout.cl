// Tells the size of every shared struct and the place of every member, in the order of the list
// CLGI_LAYOUT that stands before this text.
// SPDX-License-Identifier: MIT

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
