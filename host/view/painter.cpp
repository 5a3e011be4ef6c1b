// SPDX-License-Identifier: MIT
#include "view/painter.hpp"

#include <fmt/format.h>

#include <chrono>
#include <clgi/options.hpp>
#include <clgi/plan.hpp>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "view/canvas.hpp"

namespace clgi::view {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double rungs[] = {0.3, 2.0, 10.0};  // seconds of pictures that get finer
constexpr std::size_t rung_count = std::size(rungs);
constexpr std::uint32_t most_samples = 64;
constexpr double fine = 2e-3;                   // error of samples
constexpr std::chrono::milliseconds rest{150};  // without a change, before a picture stays
constexpr double check_seconds = 1.0;

std::vector<glm::vec3> pixels_of(const io::Image& picture) {
    const auto &r = picture.find("R")->values, &g = picture.find("G")->values,
               &b = picture.find("B")->values;
    std::vector<glm::vec3> out(r.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = {r[i], g[i], b[i]};
    return out;
}

}  // namespace

struct Painter::State {
    State(const Programs& all, Subject of, const PainterOptions& wanted, std::function<void()> call)
        : programs(all),
          subject(std::move(of)),
          options(wanted),
          painted(std::move(call)),
          preview(programs, queue(), subject, {}, coarse(), true) {}

    ~State() {
        {
            const std::lock_guard lock(mutex);
            stop = true;
        }
        changed.notify_all();
        for (std::thread* thread : {&moving, &staying})
            if (thread->joinable()) thread->join();
    }

    cl::CommandQueue queue() const {
        return {programs.context(), programs.device(), CL_QUEUE_PROFILING_ENABLE};
    }

    PlanRequest request(double seconds, std::optional<Method> method) const {
        PlanRequest out;
        out.width = options.width;
        out.height = options.height;
        out.seconds = seconds;
        out.method = method;
        out.build = options.build;
        return out;
    }

    RendererOptions sized(RendererOptions out) const {
        out.picture.width = options.width;
        out.picture.height = options.height;
        out.picture.build = options.build;
        return as_flags(out);
    }

    // Of pictures while something moves: one bounce, few VPLs and shadow maps.
    RendererOptions coarse() const {
        RendererOptions out;
        out.method = Method::second_order;
        for (const auto& [name, value] : {std::pair("vpls", "100"),
                                          {"negative-vpls", "30"},
                                          {"low-res", "0.05"},
                                          {"area-samples", "4"},
                                          {"environment-lights", "8"},
                                          {"shadow-size", "256"},
                                          {"face-size", "64"}})
            set_option(out, name, value);
        return sized(out);
    }

    // ---- what both threads look at ------------------------------------------------------------
    Shown latest() const {
        const std::lock_guard lock(mutex);
        return shown;
    }

    void publish(Drawn&& picture, const Shown& of) {
        picture.shown = of;
        {
            const std::lock_guard lock(mutex);
            // A coarse picture does not take the place of a finer one of the same.
            if (drawn && picture.preview && !drawn->preview &&
                drawn->shown.version() >= of.version())
                return;
            drawn = std::make_shared<const Drawn>(std::move(picture));
        }
        painted();
    }

    void say(const std::string& doing, const std::string& trouble = "") {
        {
            const std::lock_guard lock(mutex);
            if (status.doing == doing && status.trouble == trouble) return;
            status = {doing, trouble};
        }
        painted();
    }

    // Runs a thread's work; an error is shown and ends what was begun.
    template <typename Work>
    void guard(const Work& work) {
        try {
            work();
        } catch (const std::exception& failed) {
            say("", failed.what());
        }
    }

    // ---- each change at once ------------------------------------------------------------------
    void follow_changes() {
        std::optional<std::uint64_t> last;
        for (;;) {
            {
                std::unique_lock lock(mutex);
                changed.wait(lock, [&] { return stop || last != shown.version(); });
                if (stop) return;
            }
            const Shown now = latest();
            last = now.version();
            guard([&] { draw_change(now); });
        }
    }

    void draw_change(const Shown& now) {
        const Camera camera = camera_of(subject, now);
        {
            const std::unique_lock lock(canvas_mutex, std::try_to_lock);
            for (Canvas* one : {canvas.get(), quick.get()}) {
                if (!lock || !one || !one->is_quick() || !shows(*one, now)) continue;
                one->draw(camera);
                if (one == canvas.get()) drew(now);
                return publish(one->drawn(), now);
            }
        }
        preview.follow(now);
        preview.draw(camera);
        Drawn picture = preview.drawn();
        picture.preview = true;
        publish(std::move(picture), now);
    }

    // Without anything to prepare anew.
    bool shows(const Canvas& of, const Shown& now) const {
        return of.can_follow(now) && canvas_lit == now.lit;
    }

    // By the canvas, with its lock held.
    void drew(const Shown& now) {
        canvas_drew = now.version();
        canvas_moved = now.moved;
        error = 1.0;
    }

    // ---- what stays, finer and finer ------------------------------------------------------------
    void draw_what_stays() {
        std::optional<std::uint64_t> rests;  // where nothing is left to do
        for (;;) {
            bool moves = false;  // the camera alone does
            {
                std::unique_lock lock(mutex);
                changed.wait(lock, [&] { return stop || rests != shown.version(); });
                while (!stop && Clock::now() < changed_at + rest)
                    changed.wait_until(lock, changed_at + rest);
                if (stop) return;
                moves = Clock::now() < moved_at + rest;
            }
            const Shown now = latest();
            bool more = false;
            guard([&] { more = step(now, moves); });
            if (more) continue;
            if (moves) {
                std::unique_lock lock(mutex);
                changed.wait_until(lock, moved_at + rest);
                continue;
            }
            rests = now.version();
            if (latest().version() == now.version()) say("", troubled());
        }
    }

    std::string troubled() const {
        const std::lock_guard lock(mutex);
        return status.trouble;
    }

    // False while work on `now` is still of use; what is prepared may serve other cameras too.
    Progress while_shown(const Shown& now, const std::string& what, bool any_camera) {
        return [this, now, what, any_camera](double done) {
            say(fmt::format("{}, {:.0f} %", what, 100.0 * done));
            const std::lock_guard lock(mutex);
            if (stop || shown.set != now.set || shown.posed != now.posed || shown.lit != now.lit)
                return false;
            return any_camera || shown.moved == now.moved;
        };
    }

    // One step towards the finest picture. False if nothing is left to do.
    bool step(const Shown& now, bool moves) {
        std::unique_lock lock(canvas_mutex);
        if (canvas && (!canvas->can_follow(now) ||
                       (!canvas->serves_cameras() && canvas_moved != now.moved))) {
            canvas.reset();
            quick.reset();
        }
        if (!canvas) rung = 0;
        if (canvas && canvas_lit != now.lit) return light_anew(now);
        if (canvas && !moves && canvas_drew != now.version()) return draw_canvas(now);
        if (rung < rung_count && (!moves || climbs != now.set)) {
            lock.unlock();
            return climb(now, moves);
        }
        if (moves) return false;
        if (canvas->samples() < most_samples && (canvas->samples() < 4 || error > fine))
            return refine(now);
        lock.unlock();
        return check(now);
    }

    bool light_anew(const Shown& now) {
        quick.reset();
        canvas->follow(now);
        if (!canvas->prepare(while_shown(now, "lights anew", canvas->serves_cameras()))) {
            canvas.reset();
            return true;
        }
        canvas_lit = now.lit;
        return draw_canvas(now);
    }

    bool draw_canvas(const Shown& now) {
        canvas->draw(camera_of(subject, now));
        drew(now);
        checked.reset();
        publish(canvas->drawn(), now);
        return true;
    }

    // The next of the settings that take longer and err less.
    bool climb(const Shown& now, bool moves) {
        say("plans");
        const Scene scene = scene_of(subject, now, options.width, options.height);
        RendererOptions next =
            now.by_hand ? *now.by_hand
                        : make_plan(plan_queue, programs, scene, scene.cameras[subject.camera],
                                    request(rungs[rung], now.method));
        next = sized(next);
        const std::string text = option_text(next, methods_of(next.method));
        if (moves && next.method == Method::irradiance_cache) {
            climbs = now.set;  // of no use before the camera rests
            return false;
        }
        rung = now.by_hand ? rung_count : rung + 1;
        if (canvas && canvas->options().method == next.method && settings == text) return true;
        auto made = std::make_unique<Canvas>(programs, queue(), subject, now, next, false);
        const std::string what = fmt::format("prepares {}", name_of(next.method));
        if (!made->prepare(while_shown(now, what, made->serves_cameras()))) return true;
        const std::lock_guard lock(canvas_mutex);
        if (canvas && canvas->is_quick()) quick = std::move(canvas);
        canvas = std::move(made);
        canvas_lit = now.lit;
        settings = text;
        return draw_canvas(moves ? latest() : now);
    }

    bool refine(const Shown& now) {
        canvas->refine();
        const std::uint32_t samples = canvas->samples();
        say(fmt::format("refines, {} samples", samples));
        if (samples >= 4) error = canvas->sampling_error();
        if (samples < most_samples && error > fine && samples % 4 != 0) return true;
        publish(canvas->drawn(), now);
        return true;
    }

    bool check(const Shown& now) {
        if (checked == now.version()) return false;
        checked = now.version();
        const std::shared_ptr<const Drawn> last = picture();
        if (!last || last->preview || last->shown.version() != now.version()) return false;
        const Scene scene = scene_of(subject, now, options.width, options.height);
        const reference::PathTracer tracer(scene);
        reference::VerifyOptions wanted;
        wanted.samples = 1 << 20;  // time is the limit
        wanted.seconds = check_seconds;
        wanted.filter =
            last->options.samples > 1 ? reference::Filter::box : reference::Filter::center;
        const reference::Verification found =
            tracer.verify(scene.cameras[subject.camera], options.width, options.height,
                          pixels_of(last->picture), wanted, while_shown(now, "checks", false));
        if (found.cancelled) return true;
        Drawn with_check = *last;
        with_check.check = found;
        publish(std::move(with_check), now);
        return false;
    }

    std::shared_ptr<const Drawn> picture() const {
        const std::lock_guard lock(mutex);
        return drawn;
    }

    const Programs programs;
    const Subject subject;
    const PainterOptions options;
    const std::function<void()> painted;

    mutable std::mutex mutex;  // of what follows
    std::condition_variable changed;
    Shown shown;
    Clock::time_point moved_at = Clock::now(), changed_at = moved_at;  // anything; but the camera
    bool stop = false;
    std::shared_ptr<const Drawn> drawn;
    Status status;

    Canvas preview;           // of the first thread alone
    std::mutex canvas_mutex;  // of what follows; the second thread alone replaces it
    std::unique_ptr<Canvas> canvas;
    std::unique_ptr<Canvas> quick;  // a coarser one, while the canvas takes long
    std::uint64_t canvas_lit = 0, canvas_moved = 0, canvas_drew = 0;
    double error = 1.0;  // of its samples

    // Of the second thread alone.
    cl::CommandQueue plan_queue = queue();
    std::size_t rung = 0;
    std::string settings;  // of the canvas
    std::optional<std::uint64_t> checked;
    std::optional<std::uint64_t> climbs;  // settings that serve one camera alone

    std::thread moving, staying;
};

Painter::Painter(const Programs& programs, Subject subject, const PainterOptions& options,
                 std::function<void()> painted)
    : state_(std::make_unique<State>(programs, std::move(subject), options, std::move(painted))) {
    State& s = *state_;
    s.moving = std::thread([&s] { s.follow_changes(); });
    s.staying = std::thread([&s] { s.draw_what_stays(); });
}

Painter::~Painter() = default;

void Painter::show(const Shown& shown) {
    {
        const std::lock_guard lock(state_->mutex);
        Shown& last = state_->shown;
        state_->moved_at = Clock::now();
        if (shown.set != last.set || shown.posed != last.posed || shown.lit != last.lit)
            state_->changed_at = state_->moved_at;
        last = shown;
    }
    state_->changed.notify_all();
}

std::shared_ptr<const Drawn> Painter::drawn() const { return state_->picture(); }

Painter::Status Painter::status() const {
    const std::lock_guard lock(state_->mutex);
    return state_->status;
}

const Subject& Painter::subject() const { return state_->subject; }

}  // namespace clgi::view
