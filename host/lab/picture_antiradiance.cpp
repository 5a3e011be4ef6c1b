// Pictures of antiradiance, and how far more bins would change them.   [Dachsbacher07]
// SPDX-License-Identifier: MIT
#include <clgi/advanced/antiradiance_view.hpp>

#include "lab/picture_methods.hpp"
#include "lab/preview.hpp"
#include "lab/relative_error.hpp"
#include "lab/sweep_antiradiance.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

// A solver and what shows its light.
class Lit {
public:
    Lit(const PictureTask& task, const AntiradianceOptions& options, const Progress& part)
        : task_(task),
          solver_(task.programs, task.setup.queue, task.setup.scene, task.scene, options),
          view_(task.programs, task.setup.queue, task.scene, solver_, shown(true)) {
        if (!solver_.run(part)) throw_cancelled();
        view_.render(task.camera).wait();
    }

    double frame() {
        return time_frame(task_.setup.queue, [&] {
            solver_.lights_changed();
            view_.lights_changed();
            solver_.run();
            view_.render(task_.camera);
        });
    }

    // All light, or what arrives over links and from the sky alone.
    io::Image picture(bool direct) const {
        if (direct) return radiance_picture(task_.setup.queue, view_.picture());
        AntiradianceView view(task_.programs, task_.setup.queue, task_.scene, solver_,
                              shown(false));
        view.render(task_.camera).wait();
        return radiance_picture(task_.setup.queue, view.picture());
    }

    bool given_up() const { return solver_.status().given_up; }
    double linking_milliseconds() const { return 1e3 * solver_.linking_seconds(); }
    std::size_t non_finite() const {
        return solver_.status().non_finite + view_.picture().non_finite();
    }

private:
    PictureOptions shown(bool direct) const {
        PictureOptions out;
        out.width = task_.width;
        out.height = task_.height;
        out.emitters = solver_.options().emitters;
        out.direct = direct;
        out.build = solver_.options().build;
        return out;
    }

    const PictureTask& task_;
    AntiradianceSolver solver_;
    AntiradianceView view_;
};

// The truths that antiradiance is an answer to, and of which it can tell its error.
struct Asked {
    std::string truth;
    bool direct;
};
std::vector<Asked> asked_of(const PictureTask& task) {
    std::vector<Asked> out;
    for (const SweepTruth& truth : task.truths)
        if (truth.name == full_truth || truth.name == indirect_truth)
            out.push_back({truth.name, truth.name == full_truth});
    return out;
}

std::vector<io::Image> pictures(const std::vector<Asked>& asked, const Lit& lit) {
    std::vector<io::Image> out;
    for (const Asked& one : asked) out.push_back(lit.picture(one.direct));
    return out;
}

void judge_all(const PictureTask& task, const std::vector<Asked>& asked,
               const std::vector<io::Image>& found, SweepPoint& result) {
    result.picture = found.front();
    judge(result, task.truths);
    for (std::size_t k = 0; k < asked.size(); ++k)
        for (std::size_t t = 0; t < task.truths.size(); ++t)
            if (task.truths[t].name == asked[k].truth)
                result.error[t] = relative_error(found[k], task.truths[t].picture);
}

Measured measure(const PictureTask& task, const AntiradianceSettings& one, SweepPoint* result,
                 const Progress& part) {
    constexpr double slow = 1000.0;  // milliseconds
    const std::vector<Asked> asked = asked_of(task);
    Measured out;
    std::vector<io::Image> found;
    {
        Lit lit(task, one.options, [&](double done) { return part(0.5 * done); });
        for (int k = 0; k < 2 && out.again; ++k) {
            out.milliseconds.push_back(lit.frame());
            out.again = out.milliseconds.back() <= slow;
        }
        out.once = lit.linking_milliseconds();
        out.non_finite = lit.non_finite();
        if (!result) return out;
        result->given_up = lit.given_up();
        found = pictures(asked, lit);
    }
    judge_all(task, asked, found, *result);
    if (!one.estimate || !task.alone || result->given_up) return out;
    AntiradianceOptions twice = one.options;
    twice.bins *= 2;
    const Lit finer(task, twice, [&](double done) { return part(0.5 + 0.5 * done); });
    if (finer.given_up()) return out;
    const std::vector<io::Image> better = pictures(asked, finer);
    for (std::size_t k = 0; k < asked.size(); ++k)
        result->estimated_error[asked[k].truth] = relative_error(found[k], better[k]);
    return out;
}

}  // namespace

PictureMethod antiradiance_pictures(const PictureTask& task) {
    std::vector<AntiradianceSettings> settings =
        antiradiance_settings(task.setup.quick, task.setup.build, task.alone);
    for (AntiradianceSettings& one : settings) one.options.emitters.shadow_size = task.shadow_size;
    PictureMethod out;
    out.knobs = {"bins", "elements", "iteration", "steps", "spread", "bin-share", "storage"};
    out.settings = names_of(settings);
    out.measure = [&task, settings](std::size_t i, SweepPoint* result, const Progress& part) {
        return measure(task, settings[i], result, part);
    };
    return out;
}

}  // namespace clgi::lab
