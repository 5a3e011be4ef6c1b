// SPDX-License-Identifier: MIT
#include "view/window.hpp"

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>

#include <clgi/error.hpp>
#include <string>

namespace clgi::view {
namespace {

[[noreturn]] void refuse() {
    const char* why = nullptr;
    glfwGetError(&why);
    const std::string text = why ? why : "unknown";
    glfwTerminate();
    throw DeviceError("view: no window can be opened: " + text);
}

}  // namespace

Window::Window(int width, int height) {
    if (glfwInit() != GLFW_TRUE) refuse();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    window_ = glfwCreateWindow(width, height, "clgi", nullptr, nullptr);
    if (!window_) refuse();
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* of, int key, int, int action, int) {
        if (action == GLFW_PRESS)
            static_cast<Window*>(glfwGetWindowUserPointer(of))->pressed_.push_back(key);
    });
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // no file is left
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 330");
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

Window::~Window() {
    glDeleteTextures(1, &texture_);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::wake() { glfwPostEmptyEvent(); }

bool Window::begin(double seconds) {
    pressed_.clear();
    glfwWaitEventsTimeout(seconds);
    if (glfwWindowShouldClose(window_)) return false;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    return true;
}

void Window::end() {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::GetBackgroundDrawList()->AddImage(
        reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_)), ImVec2(0, 0), size);
    ImGui::Render();
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    glViewport(0, 0, width, height);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSwapBuffers(window_);
}

void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

void Window::set_picture(int width, int height, const std::vector<std::uint8_t>& rgba) {
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 rgba.data());
}

bool Window::holds(int key) const { return glfwGetKey(window_, key) == GLFW_PRESS; }

int Window::height() const {
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    return height;
}

}  // namespace clgi::view
