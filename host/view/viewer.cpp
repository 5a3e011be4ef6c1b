// SPDX-License-Identifier: MIT
#include "view/viewer.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <deque>
#include <exception>
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
    try {
        const std::filesystem::path file = unused(wanted);
        io::Image picture = drawn.picture;
        const std::string command = command_of(subject, drawn);
        picture.attributes["clgi:command"] = command;
        io::save_exr(picture, file, io::PixelType::half);
        fmt::print("{}: {} -o {}\n", file.string(), command, quoted(file.string()));
        std::fflush(stdout);
    } catch (const std::exception& failed) {  // a full disk closes no window
        fmt::print(stderr, "clgi: warning: {}\n", failed.what());
    }
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
        : window_(window), painter_(painter), options_(options), shown_(options.first) {
        controls_.box = bounds(painter.subject().scene);
        controls_.automatic = !options.exposure;
        controls_.stops = options.exposure.value_or(0.0f);
        controls_.panel = !options.turntable;
    }

    Viewed run() {
        while (window_.begin(0.1)) {
            if (const auto drawn = painter_.drawn()) frame(drawn);
            window_.end();
        }
        return {frames_, began_ ? seconds_since(*began_) : 0.0};
    }

private:
    void frame(const std::shared_ptr<const Drawn>& drawn) {
        const Subject& subject = painter_.subject();
        const std::uint64_t before = shown_.version();
        if (!began_) began_ = Clock::now();
        follow_input(window_, subject, *drawn, shown_, controls_);
        draw_panel(subject, *drawn, painter_.status(), rate_.a_second(), shown_, controls_);
        play();
        turn(*drawn);
        if (shown_.version() != before) painter_.show(shown_);
        present(drawn);
        if (!controls_.save || drawn->preview || drawn->shown.version() != shown_.version()) return;
        save(subject, *drawn, options_.output);
        controls_.save = false;
    }

    // The clip again and again.
    void play() {
        const double now = seconds_since(start_), step = now - last_;
        last_ = now;
        const Subject& subject = painter_.subject();
        if (!controls_.playing || !subject.scene.animation) return;
        const double duration = subject.scene.animation->clips[subject.clip].duration;
        if (!(duration > 0.0)) return;
        shown_.seconds = std::fmod(shown_.seconds.value_or(0.0) + step, duration);
        ++shown_.posed;
    }

    void turn(const Drawn& drawn) {
        if (!options_.turntable) return;
        const double now = seconds_since(*began_);
        if (now >= *options_.turntable) return window_.close();
        if (!shown_.viewpoint) shown_.viewpoint = viewpoint_of(drawn.camera, controls_.box);
        orbit(*shown_.viewpoint, 0.5 * (now - turned_), 0.0);
        turned_ = now;
        ++shown_.moved;
    }

    // What moves is followed slowly, so that it does not flicker, and seldom, as that takes long.
    void expose(const Drawn& drawn) {
        const bool first = automatic_ == 0.0f;
        if (drawn.preview && !first && seconds_since(exposed_at_) < 0.5) return;
        exposed_at_ = Clock::now();
        const float found = lab::preview_exposure(drawn.picture);
        automatic_ = drawn.preview && !first ? std::sqrt(automatic_ * found) : found;
    }

    void present(const std::shared_ptr<const Drawn>& drawn) {
        const bool fresh = drawn != presented_;
        if (fresh) {
            rate_.add();
            ++frames_;
            expose(*drawn);
        }
        const float wanted = controls_.automatic ? automatic_ : std::exp2(controls_.stops);
        if (fresh || wanted != exposure_)
            window_.set_picture(drawn->picture.width, drawn->picture.height,
                                lab::preview(drawn->picture, wanted));
        exposure_ = wanted;
        presented_ = drawn;
    }

    Window& window_;
    Painter& painter_;
    const ViewerOptions& options_;
    Shown shown_;
    Controls controls_;
    Rate rate_;
    std::shared_ptr<const Drawn> presented_;
    float automatic_ = 0.0f, exposure_ = 0.0f;  // factors
    std::size_t frames_ = 0;
    const Clock::time_point start_ = Clock::now();
    std::optional<Clock::time_point> began_;  // with the first picture
    Clock::time_point exposed_at_;
    double last_ = 0.0, turned_ = 0.0;
};

}  // namespace

Viewed view(const Programs& programs, Subject subject, const ViewerOptions& options) {
    Window window(options.pictures.width, options.pictures.height);
    Painter painter(programs, std::move(subject), options.first, options.pictures, Window::wake);
    return Viewer(window, painter, options).run();
}

}  // namespace clgi::view
