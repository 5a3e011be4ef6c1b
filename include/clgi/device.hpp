// The choice of an OpenCL device.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/opencl.hpp>
#include <string>
#include <vector>

namespace clgi {

// All devices of all platforms, in the order of the ICD loader.
// Throws DeviceError when there is no platform; the text names the ICD folders searched.
CLGI_API std::vector<cl::Device> all_devices();

// Chooses a device by "platform:CPU|GPU:name-or-index". Any field may be empty or missing. A name
// matches any part of the full name and ignores case. An empty choice takes the environment
// variable CLGI_DEVICE, else the first GPU, else the first CPU, else the first device.
// Throws DeviceError naming the choice and the available devices when nothing matches.
CLGI_API cl::Device choose_device(const std::string& choice = "");

// "platform: device name (OpenCL version)", for messages.
CLGI_API std::string describe(const cl::Device& device);

// Best number of lanes in a packet (kernels/packet.clh): 4, 8 or 16 on CPUs, 1 elsewhere.
CLGI_API int packet_width(const cl::Device& device);

}  // namespace clgi
