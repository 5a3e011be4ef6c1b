// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <cstdlib>

namespace clgi {
namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string platform_name(const cl::Device& device) {
    return cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>();
}

bool contains(const std::string& text, const std::string& part) {
    return lower(text).find(lower(part)) != std::string::npos;
}

struct Choice {
    std::string platform, kind, name;
};

Choice parse(const std::string& text) {
    Choice out;
    std::string* fields[] = {&out.platform, &out.kind, &out.name};
    std::size_t field = 0;
    for (const char c : text) {
        // The last field keeps its colons: device names may have some.
        if (c == ':' && field < 2)
            ++field;
        else
            *fields[field] += c;
    }
    const std::string kind = lower(out.kind);
    if (!kind.empty() && kind != "cpu" && kind != "gpu")
        throw Error("device: \"" + text + "\" asks for the kind " + out.kind +
                    ", CPU or GPU needed");
    return out;
}

bool is_kind(const cl::Device& device, cl_device_type kind) {
    return (device.getInfo<CL_DEVICE_TYPE>() & kind) != 0;
}

}  // namespace

std::vector<cl::Device> all_devices() {
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error&) {
        // The loader reports "no platform" as an error; it is dealt with below.
    }
    if (platforms.empty()) {
        const char* folder = std::getenv("OCL_ICD_VENDORS");
        throw DeviceError("no OpenCL platform: looked in " +
                          std::string(folder ? folder : "/etc/OpenCL/vendors") +
                          "; install pocl-opencl-icd (CPU) or your GPU vendor's OpenCL");
    }
    std::vector<cl::Device> devices;
    for (const cl::Platform& platform : platforms) {
        std::vector<cl::Device> found;
        try {
            platform.getDevices(CL_DEVICE_TYPE_ALL, &found);
        } catch (const cl::Error&) {
            continue;  // a platform whose hardware is absent
        }
        devices.insert(devices.end(), found.begin(), found.end());
    }
    if (devices.empty()) throw DeviceError("no OpenCL device on any platform");
    return devices;
}

cl::Device choose_device(const std::string& choice) {
    const std::vector<cl::Device> devices = all_devices();
    const char* variable = std::getenv("CLGI_DEVICE");
    const std::string text = !choice.empty() ? choice : variable ? variable : "";
    if (text.empty()) {
        for (const cl_device_type kind : {CL_DEVICE_TYPE_GPU, CL_DEVICE_TYPE_CPU})
            for (const cl::Device& device : devices)
                if (is_kind(device, kind)) return device;
        return devices.front();
    }
    const Choice wanted = parse(text);
    std::vector<cl::Device> matching;
    for (const cl::Device& device : devices) {
        const std::string kind = lower(wanted.kind);
        if (contains(platform_name(device), wanted.platform) &&
            (kind.empty() ||
             is_kind(device, kind == "gpu" ? CL_DEVICE_TYPE_GPU : CL_DEVICE_TYPE_CPU)))
            matching.push_back(device);
    }
    const bool is_index = !wanted.name.empty() && wanted.name.size() < 6 &&
                          std::all_of(wanted.name.begin(), wanted.name.end(),
                                      [](unsigned char c) { return std::isdigit(c) != 0; });
    if (is_index) {
        const std::size_t index = std::stoul(wanted.name);
        if (index < matching.size()) return matching[index];
    } else {
        for (const cl::Device& device : matching)
            if (contains(device.getInfo<CL_DEVICE_NAME>(), wanted.name)) return device;
    }
    std::string known;
    for (const cl::Device& device : devices)
        known += (known.empty() ? "" : "; ") + describe(device);
    throw DeviceError("device: nothing matches \"" + text + "\"; there is " + known);
}

std::string describe(const cl::Device& device) {
    return platform_name(device) + ": " + device.getInfo<CL_DEVICE_NAME>() + " (" +
           device.getInfo<CL_DEVICE_VERSION>() + ")";
}

int packet_width(const cl::Device& device) {
    if (!is_kind(device, CL_DEVICE_TYPE_CPU)) return 1;
    const cl_uint native = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
    return native >= 16 ? 16 : native >= 8 ? 8 : 4;
}

}  // namespace clgi
