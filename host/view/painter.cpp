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

#include "lab/preview.hpp"
#include "view/canvas.hpp"

namespace clgi::view {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double rungs[] = {0.3, 2.0, 10.0};  // seconds of pictures that get finer
constexpr std::size_t rung_count = std::size(rungs);
constexpr std::uint32_t most_samples = 64;
constexpr double fine = 2e-3;                   // error of samples
constexpr std::chrono::milliseconds rest{150};  // without a change, before a picture stays

}  // namespace

struct Painter::State {
    State(const Programs& all, Subject of, const Shown& first, const PainterOptions& wanted,
          std::function<void()> call)
        : programs(all),
          subject(std::move(of)),
          options(wanted),
          painted(std::move(call)),
          shown(first),
          preview(programs, queue(), subject, first, sized(preview_options()), true) {}

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
        out.refined = true;
        out.build = options.build;
        return out;
    }

    RendererOptions sized(RendererOptions out) const {
        out.picture.width = options.width;
        out.picture.height = options.height;
        out.picture.build = options.build;
        if (out.method == Method::irradiance_cache) out.picture.build.storage = Storage::full;
        return as_flags(out);
    }

    // ---- what both threads look at ------------------------------------------------------------
    Shown latest() const {
        const std::lock_guard lock(mutex);
        return shown;
    }

    // Neither older pictures than the last one nor coarser ones of the same take its place.
    void publish(Drawn&& picture) {
        {
            const std::lock_guard lock(mutex);
            const std::uint64_t version = picture.shown.version();
            if (drawn && drawn->shown.version() > version) return;
            if (drawn && picture.preview && !drawn->preview && drawn->shown.version() == version)
                return;
            drawn = std::make_shared<const Drawn>(std::move(picture));
        }
        painted();
    }

    void say(const std::string& doing) {
        {
            const std::lock_guard lock(mutex);
            if (status.doing == doing) return;
            status.doing = doing;
        }
        painted();
    }

    // Runs a thread's work; an error is shown. False after one.
    template <typename Work>
    bool guard(const Work& work) {
        try {
            work();
            return true;
        } catch (const std::exception& failed) {
            {
                const std::lock_guard lock(mutex);
                status = {"", failed.what()};
            }
            painted();
            return false;
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
        const std::shared_ptr<const Drawn> last = picture();
        if (last && !last->preview && last->shown.version() >= now.version()) return;
        {
            const std::unique_lock lock(canvas_mutex, std::try_to_lock);
            for (Canvas* one : {canvas.get(), quick.get()}) {
                if (!lock || !one || !one->is_quick() || !one->can_follow(now) ||
                    canvas_lit != now.lit)
                    continue;
                one->follow(now);
                one->draw();
                if (one == canvas.get()) drew(now);
                return publish(one->drawn());
            }
        }
        preview.follow(now);
        preview.draw();
        Drawn coarse = preview.drawn();
        coarse.preview = true;
        publish(std::move(coarse));
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
            const std::size_t before = rung;
            bool more = false;
            // Where settings cannot be drawn, coarser ones remain.
            if (!guard([&] { more = step(now, moves); })) more = canvas && rung != before;
            if (more) continue;
            if (moves) {
                std::unique_lock lock(mutex);
                changed.wait_until(lock, moved_at + rest);
                continue;
            }
            rests = now.version();
            if (latest().version() == now.version()) say("");
        }
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

    // One step towards the finest picture. moves: the camera does. False if nothing is left to do.
    bool step(const Shown& now, bool moves) {
        std::unique_lock lock(canvas_mutex);
        if (quick && !quick->can_follow(now)) quick.reset();
        if (canvas && is_stale(now, moves)) canvas.reset();
        if (!canvas) rung = 0;
        if (canvas && canvas_lit != now.lit) return light_anew(now);
        if (canvas && !moves && canvas_drew != now.version())
            return canvas_drew > now.version() || draw_canvas(now);
        if (rung < rung_count && (!moves || waits_for_rest != now.set)) {
            lock.unlock();
            return climb(now, moves);
        }
        if (moves) return false;
        if (canvas->samples() < most_samples && (canvas->samples() < 4 || error > fine))
            return refine();
        lock.unlock();
        return check(now);
    }

    bool is_stale(const Shown& now, bool moves) const {
        if (!canvas->can_follow(now)) return true;
        if (canvas_moved == now.moved) return false;
        if (!canvas->serves_cameras()) return true;
        if (moves) return false;
        const Scene scene = scene_of(subject, now);
        return !canvas->suits(
            focus_of(scene, scene.cameras[subject.camera], options.width, options.height));
    }

    // What a cancelled bake has found is not lost: the next one goes on.
    bool light_anew(const Shown& now) {
        quick.reset();
        canvas->follow(now);
        if (!canvas->prepare(while_shown(now, "lights anew", canvas->serves_cameras())))
            return true;
        canvas_lit = now.lit;
        if (rung == rung_count && !now.by_hand) --rung;  // the plan may be another one
        return draw_canvas(now);
    }

    bool draw_canvas(const Shown& now) {
        canvas->follow(now);
        canvas->draw();
        drew(now);
        checked.reset();
        publish(canvas->drawn());
        return true;
    }

    // The next of the settings that take longer and err less.
    bool climb(const Shown& now, bool moves) {
        say("plans");
        const std::size_t of = rung;
        rung = now.by_hand ? rung_count : of + 1;
        RendererOptions next;
        if (now.by_hand) {
            next = sized(*now.by_hand);
        } else {
            const Scene scene = scene_of(subject, now);
            next = sized(make_plan(plan_queue, programs, scene, scene.cameras[subject.camera],
                                   request(rungs[of], now.method)));
        }
        if (moves && next.method == Method::irradiance_cache) {
            waits_for_rest = now.set;
            rung = of;
            return false;
        }
        const std::string text = option_text(next, methods_of(next.method));
        if (canvas && canvas->options().method == next.method && settings == text) return true;
        auto made = std::make_unique<Canvas>(programs, queue(), subject, now, next, false);
        const std::string what = fmt::format("prepares {}", name_of(next.method));
        if (!made->prepare(while_shown(now, what, made->serves_cameras()))) {
            rung = of;
            return true;
        }
        const std::lock_guard lock(canvas_mutex);
        if (canvas && canvas->is_quick()) quick = std::move(canvas);
        canvas = std::move(made);
        canvas_lit = now.lit;
        settings = text;
        return draw_canvas(from_here(now));
    }

    // With the camera where it is meanwhile.
    Shown from_here(Shown now) const {
        if (!canvas->serves_cameras()) return now;
        const Shown last = latest();
        now.viewpoint = last.viewpoint;
        now.moved = last.moved;
        return now;
    }

    bool refine() {
        canvas->refine();
        const std::uint32_t samples = canvas->samples();
        say(fmt::format("refines, {} samples", samples));
        if (samples >= 4) error = canvas->sampling_error();
        if (samples < most_samples && error > fine && samples % 4 != 0) return true;
        publish(canvas->drawn());
        return true;
    }

    bool check(const Shown& now) {
        if (checked == now.version()) return false;
        checked = now.version();
        const std::shared_ptr<const Drawn> last = picture();
        if (!last || last->preview || last->shown.version() != now.version() ||
            !last->options.picture.direct)
            return false;
        const reference::PathTracer tracer(scene_of(subject, now));
        reference::VerifyOptions wanted;
        wanted.samples = 1 << 20;  // time is the limit
        wanted.seconds = options.check_seconds;
        wanted.filter =
            last->options.samples > 1 ? reference::Filter::box : reference::Filter::center;
        const reference::Verification found = tracer.verify(
            last->camera, options.width, options.height, lab::radiance_of(last->picture), wanted,
            while_shown(now, "checks", false));
        if (found.cancelled) return true;
        Drawn with_check = *last;
        with_check.check = found;
        publish(std::move(with_check));
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
    std::uint64_t canvas_lit = 0, canvas_moved = 0, canvas_drew = 0;  // parts of its version
    double error = 1.0;                                               // of its samples

    // Of the second thread alone.
    cl::CommandQueue plan_queue = queue();
    std::size_t rung = 0;
    std::string settings;  // of the canvas
    std::optional<std::uint64_t> checked;
    std::optional<std::uint64_t> waits_for_rest;  // settings that serve one camera alone

    std::thread moving, staying;
};

Painter::Painter(const Programs& programs, Subject subject, const Shown& first,
                 const PainterOptions& options, std::function<void()> painted)
    : state_(std::make_unique<State>(programs, std::move(subject), first, options,
                                     std::move(painted))) {
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
        if (shown.set != last.set) state_->status.trouble.clear();
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
