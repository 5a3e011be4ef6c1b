// Which OpenCL device to work on.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/export.hpp>
#include <clgi/opencl.hpp>
#include <string>
#include <vector>

namespace clgi {

// Every device of every platform, in the order the ICD loader gives them.
// Throws DeviceError when there is no platform; the text names the ICD folders searched.
CLGI_API std::vector<cl::Device> all_devices();

// Picks a device by "platform:CPU|GPU:name-or-index"; any field may be empty or missing, names
// match as a part of the real name, ignoring case. An empty choice takes the variable
// CLGI_DEVICE, else the first GPU, else the first CPU, else the first device.
// Throws DeviceError naming the choice and what there is when nothing matches.
CLGI_API cl::Device choose_device(const std::string& choice = "");

// "platform: device name (OpenCL version)", for people.
CLGI_API std::string describe(const cl::Device& device);

// Lanes of a packet (kernels/packet.clh) that suit the device: 4, 8 or 16 on CPUs, 1 elsewhere.
CLGI_API int packet_width(const cl::Device& device);

}  // namespace clgi
