/* Uses one of clgi's installed kernels without clgi: image/tonemap.cl, read as text and built with
   plain OpenCL. The struct and the argument list are those that the file itself states.
   SPDX-License-Identifier: MIT */
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct {
    cl_uint width, height, stride;
    cl_float exposure;
} TonemapParams;

static void need(int condition, const char* what) {
    if (condition) return;
    fprintf(stderr, "raw_kernel: %s\n", what);
    exit(1);
}

static char* read_file(const char* path) {
    FILE* file = fopen(path, "rb");
    need(file != NULL, path);
    fseek(file, 0, SEEK_END);
    const long size = ftell(file);
    rewind(file);
    char* text = calloc((size_t)size + 1, 1);
    need(text && fread(text, 1, (size_t)size, file) == (size_t)size, "the file cannot be read");
    fclose(file);
    return text;
}

static cl_device_id any_device(void) {
    cl_platform_id platforms[16];
    cl_uint count = 0;
    cl_device_id device = NULL;
    clGetPlatformIDs(16, platforms, &count);
    for (cl_uint i = 0; i < count && i < 16 && !device; ++i)
        clGetDeviceIDs(platforms[i], CL_DEVICE_TYPE_ALL, 1, &device, NULL);
    need(device != NULL, "no OpenCL device");
    return device;
}

/* 8 bits of the sRGB curve, as IEC 61966-2-1 has it. */
static unsigned encode(double v) {
    v = v < 0.0 ? 0.0 : v > 1.0 ? 1.0 : v;
    v = v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
    return (unsigned)(255.0 * v + 0.5);
}

int main(int argc, char** argv) {
    need(argc == 2, "usage: raw_kernel TONEMAP.cl");
    enum { width = 5, height = 3, pixels = width * height, stride = 16 };
    const TonemapParams params = {width, height, stride, 2.0f};
    float radiance[3 * stride] = {0};
    for (int i = 0; i < pixels; ++i) {
        radiance[i] = (float)i / pixels;
        radiance[stride + i] = -1.0f;
        radiance[2 * stride + i] = 0.25f;
    }

    cl_int error = 0;
    const cl_device_id device = any_device();
    const cl_context context = clCreateContext(NULL, 1, &device, NULL, NULL, &error);
    need(error == CL_SUCCESS, "no context");
    const cl_command_queue queue = clCreateCommandQueue(context, device, 0, &error);
    need(error == CL_SUCCESS, "no queue");
    char* source = read_file(argv[1]);
    const char* sources[] = {source};
    const cl_program program = clCreateProgramWithSource(context, 1, sources, NULL, &error);
    need(error == CL_SUCCESS, "no program");
    need(clBuildProgram(program, 1, &device, "-cl-std=CL1.2", NULL, NULL) == CL_SUCCESS,
         "the kernel does not build");
    const cl_kernel kernel = clCreateKernel(program, "image_tonemap", &error);
    need(error == CL_SUCCESS, "no kernel image_tonemap");

    const cl_mem input = clCreateBuffer(context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                                        sizeof radiance, radiance, &error);
    need(error == CL_SUCCESS, "no input buffer");
    const cl_mem output =
        clCreateBuffer(context, CL_MEM_WRITE_ONLY, pixels * sizeof(cl_uint), NULL, &error);
    need(error == CL_SUCCESS, "no output buffer");
    clSetKernelArg(kernel, 0, sizeof params, &params);
    clSetKernelArg(kernel, 1, sizeof input, &input);
    clSetKernelArg(kernel, 2, sizeof output, &output);
    const size_t items = pixels;
    need(clEnqueueNDRangeKernel(queue, kernel, 1, NULL, &items, NULL, 0, NULL, NULL) == CL_SUCCESS,
         "the kernel does not run");
    cl_uint preview[pixels];
    need(clEnqueueReadBuffer(queue, output, CL_TRUE, 0, sizeof preview, preview, 0, NULL, NULL) ==
             CL_SUCCESS,
         "no result");

    int wrong = 0;
    for (int i = 0; i < pixels; ++i) {
        /* One step of 255 is left to the device's pow. */
        const int red = (int)(preview[i] & 255) - (int)encode(2.0 * i / pixels);
        const int blue = (int)(preview[i] >> 16 & 255) - (int)encode(0.5);
        wrong += abs(red) > 1 || abs(blue) > 1 || (preview[i] >> 8 & 255) != 0 ||
                 preview[i] >> 24 != 255;
    }
    printf("image_tonemap: %d of %d pixels wrong\n", wrong, (int)pixels);
    clReleaseMemObject(output);
    clReleaseMemObject(input);
    clReleaseKernel(kernel);
    clReleaseProgram(program);
    clReleaseCommandQueue(queue);
    clReleaseContext(context);
    free(source);
    return wrong != 0;
}
