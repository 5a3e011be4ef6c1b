/* clgi's kernels without clgi: plain C99 and plain OpenCL on the installed .cl files alone.

       raw_kernels share/clgi/kernels picture.pfm [DEVICE]

   DEVICE counts the devices of all platforms from 0, as `clgi devices` lists them; the first one
   is taken where none is named.

   Draws a room with a block in it into a G-buffer (raster_views, resolve), lights every pixel by
   64 VPLs on the floor (gather) and writes irradiance as a float picture. Structs and argument
   lists are those that the files themselves state.
   SPDX-License-Identifier: MIT */
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    cl_float4 eye, right, up, forward, window;
    cl_uint width, height, first_pixel, flags;
} View;
typedef struct {
    cl_uint triangle_count, stage, small_size, first_view, capacity, late_capacity, cull, flags;
} RasterParams;
typedef struct { cl_uint stride, write, pad0, pad1; } ResolveParams;
typedef struct { cl_uint vertex_count, triangle_count, flags, cluster_count; } SceneInfo;
typedef struct { cl_uint stride, vpl_count, negative_count, pad; } GatherParams;
typedef struct { cl_float4 position, normal, flux; } Vpl;
typedef struct {
    cl_float4 base_color, emission, reflectance;
    cl_int base_texture, base_uv_set, emission_texture, emission_uv_set;
    cl_float4 base_u, base_v, emission_u, emission_v;
    cl_int normal_texture, normal_uv_set, metallic_roughness_texture, metallic_roughness_uv_set;
    cl_float4 normal_u, normal_v, metallic_roughness_u, metallic_roughness_v;
    cl_float4 surface;
} MaterialRecord;

enum { width = 160, height = 120, pixels = width * height, stride = pixels };
enum { boxes = 2, vertex_count = 24 * boxes, triangle_count = 12 * boxes, vpl_count = 64 };
enum { gbuffer_planes = 16, id_planes = 4, point_planes = 6, irradiance_planes = 3 };
enum { small_triangle = 12 }; /* pixels */

static cl_context context;
static cl_device_id device;
static cl_command_queue queue;
static const char* folder;

static void need(int condition, const char* what) {
    if (condition) return;
    fprintf(stderr, "raw_kernels: %s\n", what);
    exit(1);
}

static char* read_file(const char* path) {
    FILE* file = fopen(path, "rb");
    need(file != NULL, path);
    fseek(file, 0, SEEK_END);
    const long size = ftell(file);
    rewind(file);
    char* text = calloc((size_t)size + 1, 1);
    need(text && fread(text, 1, (size_t)size, file) == (size_t)size, path);
    fclose(file);
    return text;
}

/* Square roots and quotients rounded as IEEE 754 has it, where the device can: the same bits as
   the library gives. Packets and 64-bit atomics are left out, which changes no bit. */
static const char* build_options(void) {
    cl_device_fp_config config = 0;
    clGetDeviceInfo(device, CL_DEVICE_SINGLE_FP_CONFIG, sizeof config, &config, NULL);
    return config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT
               ? "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt"
               : "-cl-std=CL1.2";
}

/* <folder>/<room>/<pass>.cl holds the kernel <room>_<pass>. */
static cl_kernel load(const char* room, const char* pass) {
    char path[4096], name[64];
    snprintf(path, sizeof path, "%s/%s/%s.cl", folder, room, pass);
    snprintf(name, sizeof name, "%s_%s", room, pass);
    char* source = read_file(path);
    const char* sources[] = {source};
    cl_int error = 0;
    const cl_program program = clCreateProgramWithSource(context, 1, sources, NULL, &error);
    need(error == CL_SUCCESS, "no program");
    need(clBuildProgram(program, 1, &device, build_options(), NULL, NULL) == CL_SUCCESS, name);
    const cl_kernel kernel = clCreateKernel(program, name, &error);
    need(error == CL_SUCCESS, name);
    clReleaseProgram(program);
    free(source);
    return kernel;
}

static cl_mem buffer(size_t bytes, const void* data) {
    cl_int error = 0;
    void* host = (void*)data;
    const cl_mem_flags flags = CL_MEM_READ_WRITE | (data ? CL_MEM_COPY_HOST_PTR : 0);
    const cl_mem memory = clCreateBuffer(context, flags, bytes, host, &error);
    need(error == CL_SUCCESS, "no buffer");
    return memory;
}

static cl_uint set_values(cl_kernel kernel, cl_uint index, size_t bytes, const void* value) {
    need(clSetKernelArg(kernel, index, bytes, value) == CL_SUCCESS, "an argument does not fit");
    return index + 1;
}

static cl_uint set_buffers(cl_kernel kernel, cl_uint index, int count, const cl_mem* buffers) {
    for (int i = 0; i < count; ++i)
        index = set_values(kernel, index, sizeof(cl_mem), &buffers[i]);
    return index;
}

static void run(cl_kernel kernel, size_t items) {
    need(clEnqueueNDRangeKernel(queue, kernel, 1, NULL, &items, NULL, 0, NULL, NULL) == CL_SUCCESS,
         "a kernel does not run");
    clReleaseKernel(kernel);
}

/* ---- the scene: local coordinates, radius below 1 ------------------------------------------- */

static cl_float4 positions[vertex_count], normals[vertex_count];
static cl_uint4 triangles[triangle_count];

/* Six quads that face out, or in where facing is -1. */
static void add_box(int box, const float* low, const float* high, int facing) {
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const int side = face % 2, out = (side ? 1 : -1) * facing;
        const cl_uint first = (cl_uint)(24 * box + 4 * face);
        for (int corner = 0; corner < 4; ++corner) {
            cl_float4 at = {{0}}, normal = {{0}};
            at.s[axis] = side ? high[axis] : low[axis];
            at.s[u] = corner == 1 || corner == 2 ? high[u] : low[u];
            at.s[v] = corner >= 2 ? high[v] : low[v];
            normal.s[axis] = (float)out;
            /* Counter-clockwise seen from the front. */
            const cl_uint place = first + (cl_uint)(out > 0 ? corner : 3 - corner);
            positions[place] = at;
            normals[place] = normal;
        }
        const cl_uint4 halves[] = {{{first, first + 1, first + 2, 0}},
                                   {{first, first + 2, first + 3, 0}}};
        memcpy(triangles + 12 * box + 2 * face, halves, sizeof halves);
    }
}

static View view_into_the_room(void) {
    View view;
    memset(&view, 0, sizeof view);
    view.eye.s[1] = 0.125f;
    view.eye.s[2] = 0.46875f;
    view.right.s[0] = view.up.s[1] = 1.0f;
    view.right.s[3] = 1.0f; /* tangents of half the angles of view */
    view.up.s[3] = 0.75f;
    view.forward.s[2] = -1.0f;
    view.forward.s[3] = 0.0009765625f; /* near */
    view.width = width;
    view.height = height;
    view.flags = 1; /* back faces are left out */
    return view;
}

/* The floor as 8x8 discs that shine up, redder to the right. */
static void place_lights(Vpl* lights) {
    memset(lights, 0, vpl_count * sizeof *lights);
    for (int l = 0; l < vpl_count; ++l) {
        lights[l].position.s[0] = ((float)(l % 8) - 3.5f) / 8.0f;
        lights[l].position.s[1] = -0.5f;
        lights[l].position.s[2] = ((float)(l / 8) - 3.5f) / 8.0f;
        lights[l].position.s[3] = 0.00390625f; /* squared radius of the disc, and its square */
        lights[l].normal.s[1] = 1.0f;
        lights[l].normal.s[3] = 0.0000152587890625f;
        lights[l].flux.s[0] = (float)(1 + l % 8) / 256.0f;
        lights[l].flux.s[1] = lights[l].flux.s[2] = 4.0f / 256.0f;
        lights[l].flux.s[3] = 1.0f;
    }
}

/* ---- the passes ------------------------------------------------------------------------------ */

/* Returns planes: [16][stride] position, normal and more of what each pixel sees. */
static cl_mem draw(const View* view) {
    MaterialRecord white;
    memset(&white, 0, sizeof white);
    white.base_color.s[0] = white.base_color.s[1] = white.base_color.s[2] = 0.5f;
    white.reflectance.s[0] = 1.0f; /* all of it diffuse */
    white.surface.s[1] = 1.0f;     /* alpha: no lobe needs it here */
    white.base_texture = white.emission_texture = -1;
    const float nothing[256] = {0};
    const cl_mem empty = buffer(sizeof nothing, nothing);
    const cl_mem scene[] = {buffer(sizeof triangles, triangles), buffer(sizeof positions, positions),
                            buffer(sizeof normals, normals), empty, empty,
                            buffer(sizeof white, &white), empty, empty, empty};
    const cl_mem views = buffer(sizeof *view, view);
    const cl_mem visibility = buffer((size_t)pixels * sizeof(cl_ulong), NULL);
    const cl_mem planes = buffer((size_t)gbuffer_planes * stride * sizeof(cl_float), NULL);
    const cl_mem ids = buffer((size_t)id_planes * stride * sizeof(cl_int), NULL);

    /* One work-item draws the whole view; what it could pass over is not read where cull is 0. */
    const RasterParams params = {triangle_count, 0, small_triangle, 0, 0, 0, 0, 0};
    const cl_uint count = 1;
    const cl_mem seen[] = {views, empty, empty, empty};
    cl_kernel kernel = load("gbuffer", "raster_views");
    cl_uint next = set_values(kernel, 0, sizeof params, &params);
    next = set_values(kernel, next, sizeof count, &count);
    next = set_buffers(kernel, next, 4, seen);
    set_buffers(kernel, set_buffers(kernel, next, 9, scene), 1, &visibility);
    run(kernel, 1);

    const ResolveParams resolve = {stride, 0, 0, 0};
    const SceneInfo info = {vertex_count, triangle_count, 0, 0};
    const cl_mem resolved[] = {visibility, planes, ids};
    kernel = load("gbuffer", "resolve");
    next = set_values(kernel, 0, sizeof *view, view);
    next = set_values(kernel, next, sizeof resolve, &resolve);
    next = set_values(kernel, next, sizeof info, &info);
    set_buffers(kernel, set_buffers(kernel, next, 9, scene), 3, resolved);
    run(kernel, pixels);

    const cl_mem done[] = {scene[0], scene[1], scene[2], scene[5], empty, views, visibility, ids};
    for (size_t i = 0; i < sizeof done / sizeof *done; ++i) clReleaseMemObject(done[i]);
    return planes;
}

/* The first six planes are points with normals: what gather lights. */
static void gather(cl_mem points, float* irradiance) {
    Vpl lights[vpl_count];
    place_lights(lights);
    const GatherParams params = {stride, vpl_count, 0, 0};
    const cl_uint count = pixels;
    const size_t bytes = (size_t)irradiance_planes * stride * sizeof(cl_float);
    const cl_mem arguments[] = {buffer(sizeof count, &count), points,
                                buffer(sizeof lights, lights), buffer(sizeof lights[0], lights),
                                buffer(bytes, NULL)};
    const cl_kernel kernel = load("image", "gather");
    set_buffers(kernel, set_values(kernel, 0, sizeof params, &params), 5, arguments);
    run(kernel, pixels);
    need(clEnqueueReadBuffer(queue, arguments[4], CL_TRUE, 0, bytes, irradiance, 0, NULL, NULL) ==
             CL_SUCCESS,
         "no result");
    for (int i = 0; i < 5; ++i)
        if (arguments[i] != points) clReleaseMemObject(arguments[i]);
}

static void write_pfm(const char* path, const float* planes) {
    FILE* file = fopen(path, "wb");
    need(file != NULL, path);
    fprintf(file, "PF\n%d %d\n-1.0\n", width, height);
    for (int y = height - 1; y >= 0; --y) /* bottom row first */
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < irradiance_planes; ++c)
                fwrite(planes + c * stride + y * width + x, sizeof(float), 1, file);
    need(fclose(file) == 0, path);
}

static void open_device(unsigned long index) {
    cl_platform_id platforms[16];
    cl_device_id devices[64];
    cl_uint platform_count = 0;
    cl_int error = 0;
    clGetPlatformIDs(16, platforms, &platform_count);
    for (cl_uint i = 0; i < platform_count && i < 16 && !device; ++i) {
        cl_uint count = 0;
        if (clGetDeviceIDs(platforms[i], CL_DEVICE_TYPE_ALL, 64, devices, &count) != CL_SUCCESS)
            continue; /* a platform whose hardware is absent */
        if (index < count && index < 64)
            device = devices[index];
        else
            index -= count;
    }
    need(device != NULL, "no such OpenCL device");
    context = clCreateContext(NULL, 1, &device, NULL, NULL, &error);
    need(error == CL_SUCCESS, "no context");
    queue = clCreateCommandQueue(context, device, 0, &error);
    need(error == CL_SUCCESS, "no queue");
}

int main(int argc, char** argv) {
    char* rest = "";
    const unsigned long index = argc == 4 ? strtoul(argv[3], &rest, 10) : 0;
    need((argc == 3 || argc == 4) && *rest == '\0',
         "usage: raw_kernels FOLDER picture.pfm [DEVICE]");
    folder = argv[1];
    open_device(index);
    const float room[] = {-0.5f, -0.5f, -0.5f, 0.5f, 0.5f, 0.5f};
    const float block[] = {-0.25f, -0.5f, -0.25f, 0.125f, -0.0625f, 0.0f};
    add_box(0, room, room + 3, -1);
    add_box(1, block, block + 3, 1);
    const View view = view_into_the_room();
    const cl_mem planes = draw(&view);
    static float irradiance[irradiance_planes * stride];
    gather(planes, irradiance);
    write_pfm(argv[2], irradiance);
    clReleaseMemObject(planes);
    clReleaseCommandQueue(queue);
    clReleaseContext(context);
    return 0;
}
