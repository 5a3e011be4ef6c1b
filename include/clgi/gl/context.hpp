// An OpenGL context without a window, for programs that have none of their own.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <string>

namespace clgi::gl {

// OpenGL 3.3 core or later through EGL: its surfaceless platform, else its device platform. It is
// current on the thread that made it until it is destroyed. A thread has one current context.
class CLGI_API HeadlessContext {
public:
    // Throws DeviceError naming what was tried and why it failed.
    HeadlessContext();
    ~HeadlessContext();
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

    // Makes it current on the calling thread; it must not be current on another one. Throws
    // DeviceError.
    void make_current() const;

    // "surfaceless: llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5", for messages.
    const std::string& description() const { return description_; }

private:
    bool open(void* display, const std::string& platform, std::string& why);
    void close();

    void* display_ = nullptr;
    void* context_ = nullptr;
    void* surface_ = nullptr;  // of one pixel, if a context needs one
    bool counted_ = false;     // the display counts its users, so it can be released
    std::string description_;
};

}  // namespace clgi::gl
