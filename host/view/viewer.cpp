// SPDX-License-Identifier: MIT
#include "view/viewer.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <deque>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "lab/preview.hpp"
#include "view/controls.hpp"

namespace clgi::view {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

// A name that no file has: view.exr, view-1.exr and so on.
std::filesystem::path unused(const std::filesystem::path& wanted) {
    std::filesystem::path out = wanted;
    for (int n = 1; std::filesystem::exists(out); ++n)
        out = wanted.parent_path() /
              fmt::format("{}-{}{}", wanted.stem().string(), n, wanted.extension().string());
    return out;
}

void save(const Subject& subject, const Drawn& drawn, const std::filesystem::path& wanted) {
    const std::filesystem::path file = unused(wanted);
    io::Image picture = drawn.picture;
    const std::string command = command_of(subject, drawn);
    picture.attributes["clgi:command"] = command;
    io::save_exr(picture, file, io::PixelType::half);
    fmt::print("{}: {} -o {}\n", file.string(), command, file.string());
    std::fflush(stdout);
}

// How many pictures came in the last second.
class Rate {
public:
    void add() { times_.push_back(Clock::now()); }
    double a_second() {
        while (!times_.empty() && seconds_since(times_.front()) > 1.0) times_.pop_front();
        return static_cast<double>(times_.size());
    }

private:
    std::deque<Clock::time_point> times_;
};

class Viewer {
public:
    Viewer(Window& window, Painter& painter, const ViewerOptions& options)
        : window_(window), painter_(painter), options_(options) {
        shown_.viewpoint = options.viewpoint;
        shown_.method = options.method;
        shown_.seconds = options.seconds;
        controls_.automatic = !options.exposure;
        controls_.stops = options.exposure.value_or(0.0f);
        if (options.turntable) controls_.panel = false;
    }

    Viewed run() {
        painter_.show(shown_);
        while (window_.begin(0.1)) {
            const std::uint64_t before = shown_.version();
            const std::shared_ptr<const Drawn> drawn = painter_.drawn();
            if (drawn && !began_) began_ = Clock::now();
            follow_input(window_, painter_.subject(), shown_, controls_);
            draw_panel(painter_.subject(), drawn.get(), painter_.status(), rate_.a_second(), shown_,
                       controls_);
            play(drawn.get());
            turn();
            if (shown_.version() != before) painter_.show(shown_);
            present(drawn);
            window_.end();
            if (controls_.save && drawn && !drawn->preview &&
                drawn->shown.version() == shown_.version()) {
                save(painter_.subject(), *drawn, options_.output);
                controls_.save = false;
            }
        }
        return {frames_, began_ ? seconds_since(*began_) : 0.0};
    }

private:
    // A clip goes on by the time that a picture takes.
    void play(const Drawn* drawn) {
        const double now = seconds_since(start_), step = now - last_;
        last_ = now;
        if (!controls_.playing || !painter_.subject().scene.animation || !drawn) return;
        shown_.seconds = shown_.seconds.value_or(0.0) + step;
        ++shown_.posed;
    }

    void turn() {
        if (!options_.turntable || !began_) return;
        const double now = seconds_since(*began_);
        if (now >= *options_.turntable) return window_.close();
        const Subject& subject = painter_.subject();
        if (!shown_.viewpoint)
            shown_.viewpoint = viewpoint_of(camera_of(subject, shown_), bounds(subject.scene));
        orbit(*shown_.viewpoint, 0.5 * (now - turned_), 0.0);
        turned_ = now;
        ++shown_.moved;
    }

    void present(const std::shared_ptr<const Drawn>& drawn) {
        const bool fresh = drawn && drawn != presented_;
        const bool exposes = controls_.automatic || controls_.stops != stops_;
        if (!drawn || (!fresh && !exposes)) return;
        if (fresh) {
            rate_.add();
            ++frames_;
        }
        // Pictures of what moves keep the exposure, so that they do not flicker.
        if (fresh && controls_.automatic && (!drawn->preview || exposure_ == 0.0f))
            exposure_ = lab::preview_exposure(drawn->picture);
        if (!controls_.automatic) exposure_ = std::exp2(controls_.stops);
        stops_ = controls_.stops;
        if (fresh || !controls_.automatic)
            window_.set_picture(drawn->picture.width, drawn->picture.height,
                                lab::preview(drawn->picture, exposure_));
        presented_ = drawn;
    }

    Window& window_;
    Painter& painter_;
    const ViewerOptions& options_;
    Shown shown_;
    Controls controls_;
    Rate rate_;
    std::shared_ptr<const Drawn> presented_;
    float exposure_ = 0.0f, stops_ = 0.0f;
    std::size_t frames_ = 0;
    const Clock::time_point start_ = Clock::now();
    std::optional<Clock::time_point> began_;  // with the first picture
    double last_ = 0.0, turned_ = 0.0;
};

}  // namespace

Viewed view(const Programs& programs, Subject subject, const ViewerOptions& options) {
    Window window(options.pictures.width, options.pictures.height);
    Painter painter(programs, std::move(subject), options.pictures, Window::wake);
    return Viewer(window, painter, options).run();
}

}  // namespace clgi::view
