// Every struct that host and device share, member by member, for both compilers.
// SIZE(struct), MEMBER(struct, member)
// SPDX-License-Identifier: MIT
#define CLGI_LAYOUT(SIZE, MEMBER)                                                               \
    SIZE(View) MEMBER(View, eye) MEMBER(View, right) MEMBER(View, up) MEMBER(View, forward)     \
    MEMBER(View, window) MEMBER(View, width) MEMBER(View, height) MEMBER(View, first_pixel)     \
    MEMBER(View, flags)                                                                         \
    SIZE(ScreenVertex) MEMBER(ScreenVertex, x) MEMBER(ScreenVertex, y)                          \
    MEMBER(ScreenVertex, closeness) MEMBER(ScreenVertex, outside)                               \
    SIZE(RasterPolygon) MEMBER(RasterPolygon, x) MEMBER(RasterPolygon, y)                       \
    MEMBER(RasterPolygon, closeness) MEMBER(RasterPolygon, slope_x)                             \
    MEMBER(RasterPolygon, slope_y) MEMBER(RasterPolygon, closest)                               \
    MEMBER(RasterPolygon, farthest) MEMBER(RasterPolygon, origin_x)                             \
    MEMBER(RasterPolygon, origin_y) MEMBER(RasterPolygon, triangle) MEMBER(RasterPolygon, left) \
    MEMBER(RasterPolygon, top) MEMBER(RasterPolygon, right) MEMBER(RasterPolygon, bottom)       \
    MEMBER(RasterPolygon, count) MEMBER(RasterPolygon, material) MEMBER(RasterPolygon, pad0_)   \
    MEMBER(RasterPolygon, pad1_)                                                                \
    SIZE(RasterRun) MEMBER(RasterRun, left) MEMBER(RasterRun, top) MEMBER(RasterRun, right)     \
    MEMBER(RasterRun, bottom) MEMBER(RasterRun, first) MEMBER(RasterRun, count)                 \
    MEMBER(RasterRun, pad0_) MEMBER(RasterRun, pad1_)                                           \
    SIZE(RasterParams) MEMBER(RasterParams, triangle_count) MEMBER(RasterParams, stage)         \
    MEMBER(RasterParams, small_size) MEMBER(RasterParams, pad_)                                 \
    SIZE(ResolveParams) MEMBER(ResolveParams, stride) MEMBER(ResolveParams, write)              \
    MEMBER(ResolveParams, pad0_) MEMBER(ResolveParams, pad1_)                                   \
    SIZE(DownsampleParams) MEMBER(DownsampleParams, width) MEMBER(DownsampleParams, height)     \
    MEMBER(DownsampleParams, stride) MEMBER(DownsampleParams, low_stride)                       \
    MEMBER(DownsampleParams, step) MEMBER(DownsampleParams, pad0_)                              \
    MEMBER(DownsampleParams, pad1_) MEMBER(DownsampleParams, pad2_)                             \
    SIZE(ImportParams) MEMBER(ImportParams, offset) MEMBER(ImportParams, scale)                 \
    MEMBER(ImportParams, light) MEMBER(ImportParams, stride) MEMBER(ImportParams, flags)        \
    MEMBER(ImportParams, material_count) MEMBER(ImportParams, triangle_count)                   \
    MEMBER(ImportParams, normal_format) MEMBER(ImportParams, geometric_format)                  \
    MEMBER(ImportParams, albedo_format) MEMBER(ImportParams, emission_format)                   \
    MEMBER(ImportParams, pad0_) MEMBER(ImportParams, pad1_)                                     \
    SIZE(Emitter) MEMBER(Emitter, position) MEMBER(Emitter, axis) MEMBER(Emitter, right)        \
    MEMBER(Emitter, intensity) MEMBER(Emitter, shift) MEMBER(Emitter, range)                    \
    MEMBER(Emitter, measure)                                                                    \
    MEMBER(Emitter, area) MEMBER(Emitter, kind) MEMBER(Emitter, first_view)                     \
    MEMBER(Emitter, view_count) MEMBER(Emitter, first_light) MEMBER(Emitter, light_count)       \
    MEMBER(Emitter, first_index) MEMBER(Emitter, taken_over)                                    \
    MEMBER(Emitter, pad0_) MEMBER(Emitter, pad1_)                                               \
    SIZE(IndirectLight) MEMBER(IndirectLight, position) MEMBER(IndirectLight, normal)           \
    MEMBER(IndirectLight, flux)                                                                 \
    SIZE(AcceptParams) MEMBER(AcceptParams, emitter) MEMBER(AcceptParams, candidate_count)      \
    MEMBER(AcceptParams, light_count) MEMBER(AcceptParams, pad_)                                     \
    SIZE(FetchParams) MEMBER(FetchParams, light_count) MEMBER(FetchParams, emitter_count)       \
    MEMBER(FetchParams, scale) MEMBER(FetchParams, footprint)                                   \
    SIZE(NegativeParams) MEMBER(NegativeParams, light_count)                                    \
    MEMBER(NegativeParams, negative_count) MEMBER(NegativeParams, stride)                       \
    MEMBER(NegativeParams, back_facing) MEMBER(NegativeParams, footprint) \
    MEMBER(NegativeParams, shift_x) MEMBER(NegativeParams, shift_y)                             \
    MEMBER(NegativeParams, pad_)                                                                \
    SIZE(GatherParams) MEMBER(GatherParams, stride) MEMBER(GatherParams, light_count)           \
    MEMBER(GatherParams, negative_count) MEMBER(GatherParams, pad_)                             \
    SIZE(RefineParams) MEMBER(RefineParams, width) MEMBER(RefineParams, height)                 \
    MEMBER(RefineParams, stride) MEMBER(RefineParams, low_stride)                               \
    MEMBER(RefineParams, threshold) MEMBER(RefineParams, position_scale)                        \
    MEMBER(RefineParams, step) MEMBER(RefineParams, pad_)                                     \
    SIZE(CombineParams) MEMBER(CombineParams, width) MEMBER(CombineParams, height)              \
    MEMBER(CombineParams, stride) MEMBER(CombineParams, emitter_count)                          \
    MEMBER(CombineParams, exposure) MEMBER(CombineParams, texel_bias)                           \
    MEMBER(CombineParams, effects) MEMBER(CombineParams, pad_)                                  \
    SIZE(EnvironmentParams) MEMBER(EnvironmentParams, factor)                                   \
    MEMBER(EnvironmentParams, environment_width)                                                \
    MEMBER(EnvironmentParams, environment_height) MEMBER(EnvironmentParams, stride)             \
    MEMBER(EnvironmentParams, turn)                                                             \
    SIZE(TonemapParams) MEMBER(TonemapParams, width) MEMBER(TonemapParams, height)              \
    MEMBER(TonemapParams, stride) MEMBER(TonemapParams, exposure)                               \
    SIZE(MaterialRecord) MEMBER(MaterialRecord, base_color) MEMBER(MaterialRecord, emission)    \
    MEMBER(MaterialRecord, reflectance) MEMBER(MaterialRecord, base_texture)                    \
    MEMBER(MaterialRecord, base_uv_set) MEMBER(MaterialRecord, emission_texture)                \
    MEMBER(MaterialRecord, emission_uv_set) MEMBER(MaterialRecord, base_u)                      \
    MEMBER(MaterialRecord, base_v) MEMBER(MaterialRecord, emission_u)                           \
    MEMBER(MaterialRecord, emission_v)                                                          \
    SIZE(TextureRecord) MEMBER(TextureRecord, first_texel) MEMBER(TextureRecord, width)         \
    MEMBER(TextureRecord, height) MEMBER(TextureRecord, flags)                                  \
    SIZE(SceneInfo) MEMBER(SceneInfo, vertex_count) MEMBER(SceneInfo, triangle_count)           \
    MEMBER(SceneInfo, flags) MEMBER(SceneInfo, pad_)                                            \
    SIZE(ArgMax) MEMBER(ArgMax, value) MEMBER(ArgMax, index) MEMBER(ArgMax, nans)               \
    MEMBER(ArgMax, pad_)                                                                        \
    SIZE(ItemBounds) MEMBER(ItemBounds, lower) MEMBER(ItemBounds, upper)                        \
    MEMBER(ItemBounds, nans) MEMBER(ItemBounds, pad0_) MEMBER(ItemBounds, pad1_)                \
    MEMBER(ItemBounds, pad2_)                                                                   \
    SIZE(PickParams) MEMBER(PickParams, most) MEMBER(PickParams, planes)                        \
    MEMBER(PickParams, stride) MEMBER(PickParams, out_stride)                                   \
    SIZE(DigitParams) MEMBER(DigitParams, most) MEMBER(DigitParams, tiles)                      \
    MEMBER(DigitParams, shift) MEMBER(DigitParams, bits)
