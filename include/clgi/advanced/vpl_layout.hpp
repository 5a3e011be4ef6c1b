// VPLs and sample points, evenly spread over the patches of a scene. [Schaerfig16, 3.1]
//
// Patches with less area than a VPL stands for are first merged with neighbours into regions, so
// that the number of VPLs is the one asked for, however finely the scene is modelled. A point is a
// triangle and the weights b1, b2 of its second and third corner, as in SurfaceSample.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/advanced/patches.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <vector>

namespace clgi {

struct VplOptions {
    std::uint32_t count = 1600;          // VPLs on all sides together
    double density = 0.0;                // VPLs per m^2 of a side, in place of count; 0: count
    std::uint32_t samples_per_vpl = 64;  // on average, 1 to 4096
    std::uint32_t most = 1u << 20;       // more VPLs than this are an error
    // Narrow regions, such as edges of doors and window reveals, between which light passes through
    // gaps, have VPLs so many times as dense at most; 1 to 1000, 1: all alike.
    double gap_density = 20.0;
};

// A VPL. Sites of a double-sided region come in pairs: the second one lies at the same point and
// has the same samples, copied, but is on the back.
struct VplSite {
    std::uint32_t triangle;      // of the scene
    float b1, b2;                // b1, b2, 1 - b1 - b2: all at least 0
    std::uint32_t first_sample;  // in VplLayout::samples
    std::uint32_t sample_count;  // m_j, at least 1
    std::uint32_t region;        // samples belong to the nearest site of their region and side from
                                 // which no other surface divides them, if one is near; on narrow
                                 // regions, distances along them count up to ten times less
    float area;                  // m^2, A_j: its share of the region's area by samples
    bool back;                   // lies on the side that the triangle is not wound for
    float coverage = 1.0f;       // (0,1] mean of what alpha covers at its samples
};

struct SamplePoint {
    std::uint32_t triangle;  // of the scene
    float b1, b2;
};

struct VplLayout {
    std::vector<VplSite> vpls;                // by region
    std::vector<SamplePoint> samples;         // grouped by VPL, in the order of the VPLs
    std::vector<std::uint32_t> patch_region;  // [patches]
    std::uint32_t region_count = 0;
    double area = 0.0;         // m^2, both sides of double-sided triangles; the sum of the VPLs'
    double sample_area = 0.0;  // m^2, area / samples: C where no region is narrow
};

// Places options.count VPLs in proportion to area. Regions smaller than a VPL's area have one each,
// at the expense of the others, but never of more than a quarter of all VPLs: smaller patches are
// merged until that holds, with neighbours that face less than 90 degrees away or, where there are
// none, with patches near them of the same principal direction. The count is exceeded only where
// these have no room: by at most one VPL for each of six directions and side, 18 in all. With
// double-sided surfaces an odd one may be left over. An empty scene has no VPLs.
//
// A region of width w that is at least four times as long has min(gap_density, a / w^2) times as
// many VPLs for its area as others, where a is the area of a VPL if all are alike: not more than
// squares of its width need. Its VPLs lie in cells up to ten times as long as wide. All narrow
// regions together take at most a quarter of all VPLs in addition to their share.
//
// A region of more samples than VPLs has the area m C_r within C_r / 2. C_r is the area wanted for
// one, C / density; C that which leaves count * samples_per_vpl of them, where the density is 1
// everywhere area / (count * samples_per_vpl). What results differs by the roundings' sum. Regions
// smaller than C_r have one sample, of their own area.
//
// Throws Error for an option out of range, for more than `most` VPLs or 2^28 samples, and for
// patches of another scene.
CLGI_API VplLayout place_vpls(const Scene& scene, const Patches& patches,
                              const VplOptions& options = {});

}  // namespace clgi
