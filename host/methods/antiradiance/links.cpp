// SPDX-License-Identifier: MIT
#include <clgi/advanced/links.hpp>

#include <algorithm>
#include <atomic>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "core/on_threads.hpp"
#include "methods/antiradiance/linking.hpp"

namespace clgi {
namespace {

constexpr std::size_t tasks_wanted = 4096;  // many for each thread, for they differ in size

// Pairs that stand for everything, enough of them to be shared among threads.
std::vector<ElementPair> make_tasks(const ElementTree& tree, const Refine& refine) {
    std::vector<ElementPair> now, next;
    if (tree.count() > 0) now.push_back({0, 0, true, true});
    bool any = true;
    while (any && now.size() < tasks_wanted) {
        any = false;
        next.clear();
        for (ElementPair& pair : now) {
            const std::size_t before = next.size();
            if (refine(pair, next)) {
                next.push_back(pair);  // asked again later, with the same answer
            } else {
                any = any || next.size() > before;
            }
        }
        now.swap(next);
    }
    return now;
}

// What one thread found.
struct Found {
    std::vector<Link> links;
    std::size_t pairs = 0;
    std::size_t unrefined = 0;
};

// total: links of all threads, at most `most`.
void link_tasks(const Linking& linking, const std::vector<ElementPair>& tasks,
                std::atomic<std::size_t>& next, std::atomic<std::size_t>& total, std::size_t most,
                Found& out) {
    const auto all = [](std::uint32_t) { return true; };
    Exchange exchange = linking.exchange();
    std::vector<ElementPair> open;
    for (std::size_t task = next++; task < tasks.size(); task = next++) {
        open.assign(1, tasks[task]);
        const std::size_t before = out.links.size();
        out.pairs += linking(open, all, exchange, out.links);
        const std::size_t made = out.links.size() - before;
        if (total.fetch_add(made) + made > most)
            throw Error("make_links: more than " + std::to_string(most) +
                        " links; fewer elements or a larger bin_share needed");
    }
    out.unrefined = exchange.unrefined();
}

}  // namespace

Links make_links(const ElementTree& tree, const DirectionBins& bins, const LinkOptions& options,
                 const std::vector<ElementTree>& poses) {
    return make_links_up_to(std::numeric_limits<std::uint32_t>::max(), tree, bins, options, poses);
}

Links make_links_up_to(std::size_t most, const ElementTree& tree, const DirectionBins& bins,
                       const LinkOptions& options, const std::vector<ElementTree>& poses) {
    const Linking linking(tree, bins, options, poses);
    const int threads = thread_count(options.threads);
    const std::vector<ElementPair> tasks = make_tasks(tree, linking.refine());

    std::vector<Found> found(static_cast<std::size_t>(threads));
    std::atomic<std::size_t> next{0}, made{0};
    on_threads(threads, [&](int t) {
        link_tasks(linking, tasks, next, made, most, found[static_cast<std::size_t>(t)]);
    });

    // By receiver: counted, then put in place; each receiver's own are sorted after that.
    Links out;
    std::vector<std::size_t> place(tree.count() + 1, 0);
    for (const Found& part : found) {
        out.pairs += part.pairs;
        out.unrefined += part.unrefined;
        for (const Link& link : part.links) ++place[link.receiver + 1];
    }
    for (std::size_t i = 0; i < tree.count(); ++i) place[i + 1] += place[i];
    const std::size_t total = place.back();
    out.first.assign(place.begin(), place.end());
    std::vector<Link> sorted(total);
    for (Found& part : found) {
        for (const Link& link : part.links) sorted[place[link.receiver]++] = link;
        part.links = {};
    }

    resize_links(out, total);
    next = 0;
    on_threads(threads, [&](int) {
        for (std::size_t i = next++; i < tree.count(); i = next++) {
            const auto begin = sorted.begin() + out.first[i],
                       end = sorted.begin() + out.first[i + 1];
            std::sort(begin, end, by_sender);
            for (std::size_t k = out.first[i]; k < out.first[i + 1]; ++k)
                set_link(out, k, sorted[k]);
        }
    });
    for (std::size_t k = 0; !poses.empty() && k < total; ++k) list_moving(out, k, sorted[k]);
    return out;
}

}  // namespace clgi
