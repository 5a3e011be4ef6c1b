// A window with a picture, by GLFW, OpenGL and Dear ImGui, for one thread.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

struct GLFWwindow;

namespace clgi::view {

class Window {
public:
    // Throws DeviceError where none can be opened.
    Window(int width, int height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // From any thread: begin() does not wait any longer.
    static void wake();

    // Waits for something to happen, so many seconds at most, and begins a frame of Dear ImGui.
    // False once the window is closed.
    bool begin(double seconds);
    void end();  // draws the picture, scaled to the window, and the frame over it
    void close();

    // rgba: [height][width][4] sRGB, row 0 at the top.
    void set_picture(int width, int height, const std::vector<std::uint8_t>& rgba);

    // Keys of GLFW pressed since the last begin().
    const std::vector<int>& pressed() const { return pressed_; }
    bool holds(int key) const;
    int height() const;

private:
    GLFWwindow* window_ = nullptr;
    unsigned texture_ = 0;
    std::vector<int> pressed_;
};

}  // namespace clgi::view
