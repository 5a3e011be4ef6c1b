// Pictures of what is shown, by two threads: one draws each change at once and coarsely; the other
// draws what stays, finer and finer, then checks it against a path tracer. Neither waits for the
// other.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>

#include "view/shown.hpp"

namespace clgi::view {

struct PainterOptions {
    int width = 640, height = 480;
    BuildOptions build;
    double check_seconds = 1.0;  // of a picture that is finished
};

class Painter {
public:
    // painted: called by either thread after each picture, and when status() has changed. Throws
    // what a Renderer does where not even a coarse picture is possible.
    Painter(const Programs& programs, Subject subject, const Shown& first,
            const PainterOptions& options, std::function<void()> painted);
    ~Painter();  // cancels
    Painter(const Painter&) = delete;
    Painter& operator=(const Painter&) = delete;

    void show(const Shown& shown);

    // The last picture; null before the first.
    std::shared_ptr<const Drawn> drawn() const;

    struct Status {
        std::string doing;    // "prepares atlas, 40 %"; empty: nothing is left to do
        std::string trouble;  // the last error of these settings
    };
    Status status() const;

    const Subject& subject() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi::view
