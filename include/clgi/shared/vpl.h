// VPLs spread over the surface, the sample points around them, and the transport between them.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_VPL_H
#define CLGI_SHARED_VPL_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// What a VPL stands for: a part of a patch, and the sample points spread over it.
typedef struct {
    uint first_sample;
    uint sample_count;  // at least 1
    float area;         // local units squared, times what alpha covers of it
    uint flags;         // SITE_...
} Site;

enum {
    SITE_BACK = 1,      // on the back of a double-sided triangle
    SITE_ROW_SHIFT = 8  // the bits from here on: k, the site's row of transport is divided by 2^k
};

// By what numbers of the site's row are to be multiplied: 2^k.
#define SITE_ROW_UNIT(flags) ((float)(1u << ((flags) >> SITE_ROW_SHIFT)))
enum { SITE_ROW_MOST = 24 };  // largest k: smaller sites are too small for floats anyway

// Planes of the sites. The first six are those of a set of points, so hemicubes can stand on them.
enum {
    SITE_POSITION = 0,   // local frame
    SITE_NORMAL = 3,     // of the triangle, unit; 0 where there is no surface
    SITE_ALBEDO = 6,     // diffuse reflectance, mean of the samples, [0, SITE_BRIGHTEST]
    SITE_PLANES = 9
};

// A surface that reflects everything would never end to shoot.
#define SITE_BRIGHTEST 0.9990234375f  // 1 - 2^-10

// Planes of the light at the sites, exposed lux.
enum {
    SITE_UNSHOT = 0,    // irradiance that was not sent on yet
    SITE_RECEIVED = 3,  // all irradiance
    SITE_LIGHT_PLANES = 6
};

typedef struct {
    uint site_count;
    uint stride;         // of the planes of sites
    uint sample_count;
    uint sample_stride;  // of the planes of samples
} SiteParams;

// Sample points at which sites are looked at when others shoot. Each site has room for as many: a
// divisor or a multiple of a packet, so that a packet holds several sites or parts of one.
typedef struct {
    uint site_count;
    uint sample_stride;  // of the planes of samples
    uint most_samples;   // of a site, the first of its own, that are looked at
    uint per_site;       // places for them
    uint stride;         // of the planes of points
    uint pad0_;
    uint pad1_;
    uint pad2_;
} PointParams;

enum { SITE_POINT_POSITION = 0, SITE_POINT_NORMAL = 3, SITE_POINT_GEOMETRIC = 6, SITE_POINT_PLANES = 9 };

// Shooting sites with their hemicubes, and the rows of transport that belong to them: all rows are
// kept, one for every site, or only those of the shooters.
typedef struct {
    uint first_shooter;  // in the list of chosen sites
    uint shooter_count;
    uint kept;  // 1: the row of a site has its number; 0: the shooters' rows follow each other
    uint site_count;
    uint stride;         // of the planes of sites, and of the rows
    uint sample_stride;  // of the planes of samples
    uint size;           // pixels, width of the hemicubes' faces
    float row_scale;     // multiplies the transport, so that a half holds it: the area of all sites;
                         // SITE_ROW_UNIT of a small site divides it
    uint most_samples;   // as in PointParams; set by the pass, as the next two
    uint per_site;
    uint point_stride;   // of the planes of points
    float lift;          // of what stands for a hemicube where there is none, local units
} TransportParams;

enum { TRANSPORT_SHOOTERS = 8 };  // of a work-item of transport_open

typedef struct {
    uint first_shooter;  // as in TransportParams
    uint shooter_count;
    uint kept;
    uint site_count;
    uint stride;
    float per_row_scale;  // 1 / TransportParams::row_scale
    uint mode;            // SHOOT_...
    float threshold;      // power below which nothing is shot, exposed lumen
} ShootParams;

enum { SHOOT_ALL = 0, SHOOT_STRONGEST = 1 };

// Sending what the sites hold on to the texels.
typedef struct {
    uint site_count;
    uint stride;
    uint sample_stride;
    float least;  // change of a site's samples that is worth sending, exposed lumen; below 0: any is
} SendParams;

// Factors of the transport, planes of [stride] each: of the shooter, of the receiver, and the share
// of the shooter's hemisphere in which it meets surfaces.
enum { BALANCE_SHOOTER = 0, BALANCE_RECEIVER = 1, BALANCE_REACH = 2, BALANCE_PLANES = 3 };

CLGI_SHARED_END

#endif
